// lib2geom behind peers.hpp.

#include <2geom/basic-intersection.h>
#include <2geom/bezier.h>
#include <2geom/d2.h>

#include <exception>

#include "peers/peers.hpp"

namespace peers {

bool lib2geom_intersect(std::span<const bezel::Vec2> a, std::span<const bezel::Vec2> b,
                        double precision, std::vector<Parameters>& out) {
  static thread_local std::vector<Geom::Point> p, q;
  static thread_local std::vector<std::pair<double, double>> found;
  const auto convert = [](std::span<const bezel::Vec2> from, std::vector<Geom::Point>& to) {
    to.clear();
    for (const bezel::Vec2& c : from) to.emplace_back(c.x(), c.y());
  };
  convert(a, p);
  convert(b, q);
  found.clear();
  out.clear();
  try {
    Geom::find_intersections_bezier_clipping(found, p, q, precision);
  } catch (const std::exception&) {
    return false;
  }
  for (const auto& [s, t] : found) out.push_back({s, t});
  return true;
}

void lib2geom_evaluate(std::span<const bezel::Vec2> c, std::span<const double> s,
                       std::span<bezel::Vec2> out) {
  std::vector<double> x, y;
  for (const bezel::Vec2& p : c) {
    x.push_back(p.x());
    y.push_back(p.y());
  }
  const Geom::D2<Geom::Bezier> curve{Geom::Bezier(x), Geom::Bezier(y)};
  for (std::size_t i = 0; i < s.size(); ++i) {
    const Geom::Point p = curve.valueAt(s[i]);
    out[i] = bezel::Vec2{{p.x(), p.y()}};
  }
}

}  // namespace peers
