#include "bezel/mesh/planar.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "bezel/mesh/delaunay.hpp"
#include "bezel/mesh/morton.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel::planar {
namespace {

using short_names::at;

/// Buckets of side r: points closer than r to a place lie in its bucket or the eight around it.
class Buckets {
 public:
  Buckets(const Box2& box, double r) : origin_(box.lo), r_(r) {
    nx_ = static_cast<std::int64_t>((box.hi[0] - box.lo[0]) / r) + 1;
    ny_ = static_cast<std::int64_t>((box.hi[1] - box.lo[1]) / r) + 1;
    first_.assign(static_cast<std::size_t>(nx_ * ny_), -1);
  }
  void insert(const Vec2& p) {
    auto& head = first_[bucket(cell(p[0], 0), cell(p[1], 1))];
    next_.push_back(head);
    points_.push_back(p);
    head = static_cast<std::int32_t>(points_.size()) - 1;
  }
  bool crowded(const Vec2& p) const {
    const std::int64_t i = cell(p[0], 0), j = cell(p[1], 1);
    for (std::int64_t y = std::max<std::int64_t>(j - 1, 0); y <= std::min(j + 1, ny_ - 1); ++y)
      for (std::int64_t x = std::max<std::int64_t>(i - 1, 0); x <= std::min(i + 1, nx_ - 1); ++x)
        for (std::int32_t k = first_[bucket(x, y)]; k >= 0;
             k = next_[static_cast<std::size_t>(k)]) {
          const Vec2 d = points_[static_cast<std::size_t>(k)] - p;
          if (dot(d, d) < r_ * r_) return true;
        }
    return false;
  }

 private:
  std::int64_t cell(double x, int axis) const {
    const auto i = static_cast<std::int64_t>((x - origin_[axis]) / r_);
    return std::clamp<std::int64_t>(i, 0, (axis == 0 ? nx_ : ny_) - 1);
  }
  std::size_t bucket(std::int64_t i, std::int64_t j) const {
    return static_cast<std::size_t>(j * nx_ + i);
  }

  Vec2 origin_;
  double r_;
  std::int64_t nx_ = 0, ny_ = 0;
  std::vector<std::int32_t> first_, next_;
  std::vector<Vec2> points_;
};

/// Triangles with their neighbours. A side is 3 * triangle + number; none is -1.
class Surface {
 public:
  explicit Surface(Triangulation& t) : p_(t.points), triangle_(t.triangles) {}

  /// Finds the neighbours; false when a side has three triangles or both triangles the same
  /// direction, when a boundary side is no segment or a segment no side, or a point has no
  /// triangle.
  bool connect(const std::vector<Segment>& segments) {
    struct Key {
      std::uint64_t corners;
      std::int32_t side;  // -1: a boundary segment
      bool forward;
      bool operator<(const Key& b) const {
        return corners != b.corners ? corners < b.corners : side < b.side;
      }
    };
    std::vector<Key> keys;
    keys.reserve(3 * triangle_.size() + segments.size());
    const auto add = [&](int a, int b, std::int32_t side) {
      const auto low = static_cast<std::uint64_t>(std::min(a, b));
      keys.push_back({low << 32 | static_cast<std::uint64_t>(std::max(a, b)), side, a < b});
    };
    // Seen from outside, a segment is the neighbour across: its direction is opposite.
    for (const Segment& s : segments) add(s.b, s.a, -1);
    std::vector<bool> used(p_.size(), false);
    for (std::size_t t = 0; t < triangle_.size(); ++t)
      for (int s = 0; s < 3; ++s) {
        add(triangle_[t][at(s)], triangle_[t][at((s + 1) % 3)],
            static_cast<std::int32_t>(3 * t) + s);
        used[at(triangle_[t][at(s)])] = true;
      }
    std::sort(keys.begin(), keys.end());
    across_.assign(3 * triangle_.size(), -1);
    for (std::size_t k = 0; k < keys.size(); k += 2) {
      if (k + 1 == keys.size() || keys[k].corners != keys[k + 1].corners ||
          keys[k].forward == keys[k + 1].forward || keys[k + 1].side < 0)
        return false;
      if (k + 2 < keys.size() && keys[k + 2].corners == keys[k].corners) return false;
      if (keys[k].side >= 0) across_[at(keys[k].side)] = keys[k + 1].side;
      across_[at(keys[k + 1].side)] = keys[k].side;
    }
    return std::find(used.begin(), used.end(), false) == used.end();
  }

  /// Lawson's algorithm: flips until every inner side is locally Delaunay.
  void flip_to_delaunay() {
    std::vector<std::int32_t> stack;
    for (std::size_t side = across_.size(); side-- > 0;)
      if (across_[side] > static_cast<std::int32_t>(side))
        stack.push_back(static_cast<std::int32_t>(side));
    // Every flip lowers the lifted surface; the limit only guards against rounding.
    std::size_t left = 100 * triangle_.size() + 1000;
    while (!stack.empty() && left > 0) {
      const std::int32_t side = stack.back();
      stack.pop_back();
      if (across_[at(side)] < 0 || !improves(side)) continue;
      --left;
      flip(side, stack);
    }
  }

  /// Moves the points from `fixed` on, each towards the mean of its neighbours.
  void relax(std::size_t fixed) {
    std::vector<std::int32_t> offset(p_.size() + 1, 0), star(3 * triangle_.size());
    for (const auto& t : triangle_)
      for (const int v : t) ++offset[at(v) + 1];
    for (std::size_t v = 0; v < p_.size(); ++v) offset[v + 1] += offset[v];
    std::vector<std::int32_t> next(offset.begin(), offset.end() - 1);
    for (std::size_t t = 0; t < triangle_.size(); ++t)
      for (const int v : triangle_[t]) star[at(next[at(v)]++)] = static_cast<std::int32_t>(t);

    for (std::size_t v = fixed; v < p_.size(); ++v) {
      Vec2 mean{};
      const auto begin = at(offset[v]), end = at(offset[v + 1]);
      // Around an inner point every neighbour belongs to two triangles, so all weigh the same.
      for (std::size_t k = begin; k < end; ++k)
        for (const int corner : triangle_[at(star[k])])
          if (at(corner) != v) mean += p_[at(corner)] - p_[v];
      mean *= 0.5 / static_cast<double>(end - begin);
      const auto worst = [&] {
        double q = 1;
        for (std::size_t k = begin; k < end; ++k) q = std::min(q, quality(triangle_[at(star[k])]));
        return q;
      };
      const double before = worst();
      const Vec2 old = p_[v];
      p_[v] = old + mean;
      constexpr double good = 0.6;  // of an equilateral triangle's 1: no need to hold on to more
      if (worst() < std::min(before, good)) p_[v] = old;
    }
  }

 private:
  /// 1 for an equilateral triangle, 0 for a flat one, negative when clockwise.
  double quality(const std::array<int, 3>& t) const {
    const Vec2 a = p_[at(t[1])] - p_[at(t[0])], b = p_[at(t[2])] - p_[at(t[0])], c = b - a;
    const double sum = dot(a, a) + dot(b, b) + dot(c, c);
    return 2 * std::sqrt(3.0) * cross(a, b) / sum;
  }

  const Vec2& corner(std::int32_t side, int offset) const {
    return p_[at(triangle_[at(side / 3)][at((side % 3 + offset) % 3)])];
  }

  /// The angles opposite to the side sum to more than a straight angle.
  bool improves(std::int32_t side) const {
    const std::int32_t other = across_[at(side)];
    const Vec2 &a = corner(side, 0), &b = corner(side, 1), &c = corner(side, 2),
               &d = corner(other, 2);
    const double cross1 = cross(a - c, b - c), dot1 = dot(a - c, b - c);
    const double cross2 = cross(b - d, a - d), dot2 = dot(b - d, a - d);
    const double sine = cross1 * dot2 + cross2 * dot1;  // of the sum of the two angles
    // The margin keeps cocircular points from flipping back and forth on rounding errors.
    return sine < -1e-10 * (std::abs(cross1 * dot2) + std::abs(cross2 * dot1));
  }

  void join(std::int32_t side, std::int32_t other) {
    across_[at(side)] = other;
    if (other >= 0) across_[at(other)] = side;
  }

  /// Triangles (a, b, c) and (b, a, d) become (a, d, c) and (d, b, c).
  void flip(std::int32_t side, std::vector<std::int32_t>& stack) {
    const std::int32_t other = across_[at(side)];
    const std::int32_t t = side / 3, s = side % 3, u = other / 3, r = other % 3;
    const int a = triangle_[at(t)][at(s)], b = triangle_[at(t)][at((s + 1) % 3)];
    const int c = triangle_[at(t)][at((s + 2) % 3)], d = triangle_[at(u)][at((r + 2) % 3)];
    const std::int32_t bc = across_[at(3 * t + (s + 1) % 3)], ca = across_[at(3 * t + (s + 2) % 3)];
    const std::int32_t ad = across_[at(3 * u + (r + 1) % 3)], db = across_[at(3 * u + (r + 2) % 3)];
    triangle_[at(t)] = {a, d, c};
    triangle_[at(u)] = {d, b, c};
    join(3 * t, ad);
    join(3 * t + 2, ca);
    join(3 * u, db);
    join(3 * u + 1, bc);
    join(3 * t + 1, 3 * u + 2);
    for (const std::int32_t changed : {3 * t, 3 * t + 2, 3 * u, 3 * u + 1})
      stack.push_back(changed);
  }

  std::vector<Vec2>& p_;
  std::vector<std::array<int, 3>>& triangle_;
  std::vector<std::int32_t> across_;
};

/// Numbers the points from `fixed` on and the triangles so that neighbours in the plane are near
/// each other in the lists.
void number_along_plane(Triangulation& t, std::size_t fixed) {
  const std::vector<Vec2> before(t.points.begin() + static_cast<std::ptrdiff_t>(fixed),
                                 t.points.end());
  const std::vector<std::int32_t> order = morton_order(before);
  std::vector<int> number(t.points.size());
  for (std::size_t i = 0; i < fixed; ++i) number[i] = static_cast<int>(i);
  for (std::size_t i = 0; i < order.size(); ++i) {
    t.points[fixed + i] = before[at(order[i])];
    number[fixed + at(order[i])] = static_cast<int>(fixed + i);
  }
  std::vector<Vec2> centres;
  for (auto& triangle : t.triangles) {
    Vec2 sum;
    for (int& v : triangle) {
      v = number[at(v)];
      sum += t.points[at(v)];
    }
    centres.push_back(sum);
  }
  const std::vector<std::array<int, 3>> triangles = t.triangles;
  const std::vector<std::int32_t> placed = morton_order(centres);
  for (std::size_t i = 0; i < placed.size(); ++i) t.triangles[i] = triangles[at(placed[i])];
}

}  // namespace

bool smooth(Triangulation& t, std::size_t fixed, int sweeps) {
  Surface surface(t);
  if (!surface.connect(t.segments)) return false;
  surface.flip_to_delaunay();
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    surface.relax(fixed);
    surface.flip_to_delaunay();
  }
  return true;
}

bool fill(Triangulation& t, const Domain& domain, RandomStream& random) {
  const std::size_t fixed = t.points.size();
  // Equilateral triangles of side h have area sqrt(3)/4 h^2; a disc with V points, B of them on its
  // boundary, has 2V - B - 2 triangles.
  const double triangles = domain.area / (std::sqrt(3.0) / 4 * domain.size * domain.size);
  const double inner = std::round(0.5 * (triangles - static_cast<double>(fixed)) + 1);
  const std::size_t wanted =
      std::max(domain.least_points, static_cast<std::size_t>(std::max(inner, 0.0)));

  // Saturated random sampling with distance r gives 0.70 / r^2 points per area [feder1980]; 1.155 /
  // h^2 are wanted, which r = 0.75 h reaches shortly before saturation.
  Box2 box;
  for (const Vec2& p : t.points) box.include(p);
  Buckets buckets(box, 0.75 * domain.size);
  for (const Vec2& p : t.points) buckets.insert(p);
  for (std::size_t tries = 40 * wanted + 1000; tries > 0 && t.points.size() < fixed + wanted;
       --tries) {
    const double x = random.uniform(box.lo[0], box.hi[0]);
    const Vec2 p{{x, random.uniform(box.lo[1], box.hi[1])}};
    if (!domain.inside(p, domain.margin) || buckets.crowded(p)) continue;
    buckets.insert(p);
    t.points.push_back(p);
  }
  if (t.points.size() < fixed + domain.least_points) return false;

  t.triangles.clear();
  for (const auto& corners : delaunay(t.points))
    if (domain.keep(corners)) t.triangles.push_back(corners);
  constexpr int sweeps = 12;
  if (!smooth(t, fixed, sweeps)) return false;
  number_along_plane(t, fixed);
  return true;
}

}  // namespace bezel::planar
