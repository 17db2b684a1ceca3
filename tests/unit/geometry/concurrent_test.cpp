// Nothing is shared between calls: several threads at once give what one gives, bit for bit.

#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "bezel/base/random.hpp"
#include "bezel/geometry/curve.hpp"
#include "bezel/geometry/self_intersection.hpp"
#include "bezel/geometry/triangle_intersection.hpp"

namespace {

using bezel::Vec2;
using Points = std::vector<Vec2>;

Points random_points(bezel::RandomStream& random, std::size_t n) {
  Points out(n);
  for (Vec2& p : out) {
    const double x = random.uniform(), y = random.uniform();
    p = Vec2{{x, y}};
  }
  return out;
}

/// Numbers that depend on every verdict.
std::vector<double> answers(const std::vector<Points>& curves,
                            const std::vector<Points>& triangles) {
  std::vector<double> out;
  for (std::size_t i = 0; i + 1 < curves.size(); ++i) {
    for (const double tol : {0.0, 1e-12}) {
      bezel::IntersectOptions options;
      options.coincidence_distance = tol;
      const auto found = intersect(curves[i], curves[i + 1], options);
      for (const auto& c : found.crossings)
        out.insert(out.end(), {c.s, c.t, c.condition, static_cast<double>(c.sign)});
      for (const auto& c : found.tangencies)
        out.insert(out.end(), {c.s, c.t, static_cast<double>(c.order)});
      for (const auto& o : found.overlaps) out.insert(out.end(), {o.s0, o.s1, o.t0, o.t1});
      out.push_back(static_cast<double>(found.unresolved.size()));
    }
    for (const auto& c : bezel::self_intersections(curves[i]).pairs.crossings)
      out.insert(out.end(), {c.s, c.t});
    out.push_back(bezel::foot_point(curves[i], Vec2{{0.5, 0.5}}).s);
  }
  for (std::size_t i = 0; i + 1 < triangles.size(); ++i) {
    const auto found = bezel::intersect(1, triangles[i], 1, triangles[i + 1]);
    for (const auto& polygon : found.polygons) out.push_back(area(polygon));
  }
  return out;
}

TEST(Concurrent, IntersectionsFromSeveralThreads) {
  bezel::RandomStream random("Concurrent.IntersectionsFromSeveralThreads", 1);
  std::vector<Points> curves, triangles;
  for (std::size_t i = 0; i < 60; ++i) curves.push_back(random_points(random, 2 + i % 5));
  // Contacts, a cusp, a curve and itself: exact numbers are needed.
  curves.insert(curves.end(), {{{{-1, 1}}, {{0, -1}}, {{1, 1}}},
                               {{{-1, 0}}, {{1, 0}}},
                               {{{0, 0}}, {{1, 1}}, {{0, 1}}, {{1, 0}}},
                               {{{-1, 0.75}}, {{2, 0.75}}},
                               {{{0, 0}}, {{2, 1}}, {{-1, 1}}, {{1, 0}}},
                               {{{0, 0}}, {{2, 1}}, {{-1, 1}}, {{1, 0}}}});
  while (triangles.size() < 40) {
    Points t = random_points(random, 3);
    if (cross(t[1] - t[0], t[2] - t[0]) < 0) std::swap(t[1], t[2]);
    triangles.push_back(t);
  }
  const std::vector<double> alone = answers(curves, triangles);
  ASSERT_GT(alone.size(), 300u);
  std::vector<std::vector<double>> results(4);
  std::vector<std::thread> threads;
  for (auto& result : results)
    threads.emplace_back([&curves, &triangles, &result] { result = answers(curves, triangles); });
  for (std::thread& t : threads) t.join();
  for (const auto& result : results) EXPECT_EQ(result, alone);
}

}  // namespace
