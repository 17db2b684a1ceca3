#include "bezel/mesh/delaunay.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "bezel/base/error.hpp"
#include "bezel/mesh/predicates.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel {
namespace {

using short_names::at;

/// Position of (x, y), each below 2^16, along a Hilbert curve.
std::uint32_t hilbert(std::uint32_t x, std::uint32_t y) {
  std::uint32_t position = 0;
  for (std::uint32_t bit = 1U << 15; bit > 0; bit >>= 1) {
    const std::uint32_t rx = (x & bit) != 0 ? 1 : 0, ry = (y & bit) != 0 ? 1 : 0;
    position = position << 2 | ((3 * rx) ^ ry);
    if (ry == 0) {
      if (rx == 1) x = ~x, y = ~y;
      std::swap(x, y);
    }
  }
  return position;
}

/// Rounds of about 1, 2, 4, … 2^k times as many points, each along a Hilbert curve: neighbours in
/// time are near in space, and no order of the input is bad [amenta2003].
std::vector<int> insertion_order(std::span<const Vec2> points) {
  Box2 box;
  for (const Vec2& p : points) box.include(p);
  struct Key {
    int round;
    std::uint32_t place;
    int number;
  };
  std::vector<Key> keys(points.size());
  const double extent = std::max(box.hi[0] - box.lo[0], box.hi[1] - box.lo[1]);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::uint64_t random = (i + 1) * 0x9e3779b97f4a7c15ULL;  // SplitMix64
    random = (random ^ (random >> 30)) * 0xbf58476d1ce4e5b9ULL;
    random = (random ^ (random >> 27)) * 0x94d049bb133111ebULL;
    random ^= random >> 31;
    int round = 0;
    while (round < 63 && (random >> round & 1) != 0) ++round;
    const auto cell = [&](int axis) {
      return static_cast<std::uint32_t>((points[i][axis] - box.lo[axis]) / extent * 65535.0);
    };
    keys[i] = {-round, hilbert(cell(0), cell(1)), static_cast<int>(i)};
  }
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
    if (a.round != b.round) return a.round < b.round;
    return a.place != b.place ? a.place < b.place : a.number < b.number;
  });
  std::vector<int> order;
  order.reserve(keys.size());
  for (const Key& key : keys) order.push_back(key.number);
  return order;
}

/// Incremental insertion. Outside every side of the hull stands a ghost triangle, whose third
/// corner is the point at infinity; so hull and inside need no different treatment.
class Insertion {
 public:
  explicit Insertion(std::span<const Vec2> points) : p_(points), starting_at_(points.size() + 1) {
    triangle_.reserve(2 * points.size());
  }

  void start(int a, int b, int c) {
    const int inside = create(a, b, c);
    const std::array<int, 3> corner{a, b, c};
    std::array<int, 3> outside{};
    for (int s = 0; s < 3; ++s)
      outside[at(s)] = create(corner[at((s + 1) % 3)], corner[at(s)], ghost);
    for (int s = 0; s < 3; ++s) {
      join(inside, s, outside[at(s)], 0);
      // The ghost of side s ends at corner s, where the ghost of side s-1 starts.
      join(outside[at(s)], 1, outside[at((s + 2) % 3)], 2);
    }
    last_ = inside;
  }

  void insert(int v) {
    const int found = locate(v);
    if (found < 0) return;  // coincides with a corner
    cavity_.assign(1, found);
    rim_.clear();
    triangle_[at(found)].dead = true;
    for (std::size_t k = 0; k < cavity_.size(); ++k) {
      const int t = cavity_[k];
      for (int s = 0; s < 3; ++s) {
        const int next = triangle_[at(t)].across[at(s)];
        if (triangle_[at(next)].dead) continue;
        if (conflicts(next, v)) {
          triangle_[at(next)].dead = true;
          cavity_.push_back(next);
        }
      }
    }
    for (const int t : cavity_)
      for (int s = 0; s < 3; ++s) {
        const int next = triangle_[at(t)].across[at(s)];
        if (!triangle_[at(next)].dead)
          rim_.push_back({corner(t, s), corner(t, s + 1), next, side_towards(next, t)});
      }
    // The rim is one closed walk around v; every side of it becomes a triangle with v.
    std::size_t reused = 0;
    for (Rim& side : rim_) {
      if (reused < cavity_.size()) {
        side.triangle = cavity_[reused++];
        triangle_[at(side.triangle)] = {{side.from, side.to, v}, {}, false};
      } else {
        side.triangle = create(side.from, side.to, v);
      }
      starting_at_[at(side.from + 1)] = side.triangle;
    }
    for (const Rim& side : rim_) {
      join(side.triangle, 0, side.outer, side.outer_side);
      join(side.triangle, 1, starting_at_[at(side.to + 1)], 2);
      if (side.from != ghost && side.to != ghost) last_ = side.triangle;
    }
  }

  std::vector<std::array<int, 3>> take() const {
    std::vector<std::array<int, 3>> out;
    out.reserve(triangle_.size());
    for (std::size_t t = 0; t < triangle_.size(); ++t)
      if (ghost_position(static_cast<int>(t)) < 0) out.push_back(triangle_[t].corner);
    return out;
  }

 private:
  static constexpr int ghost = -1;
  struct Triangle {
    std::array<int, 3> corner{}, across{};
    bool dead = false;
  };
  /// A side of the cavity, with the cavity on its left.
  struct Rim {
    int from, to;
    int outer, outer_side;
    int triangle = -1;
  };

  int create(int a, int b, int c) {
    triangle_.push_back({{a, b, c}, {}, false});
    return static_cast<int>(triangle_.size()) - 1;
  }
  int corner(int t, int s) const { return triangle_[at(t)].corner[at(s % 3)]; }
  const Vec2& point(int v) const { return p_[at(v)]; }
  void join(int t, int s, int other, int r) {
    triangle_[at(t)].across[at(s)] = other;
    triangle_[at(other)].across[at(r)] = t;
  }
  int side_towards(int t, int other) const {
    for (int s = 0; s < 2; ++s)
      if (triangle_[at(t)].across[at(s)] == other) return s;
    return 2;
  }
  int ghost_position(int t) const {
    for (int s = 0; s < 3; ++s)
      if (corner(t, s) == ghost) return s;
    return -1;
  }

  /// v lies inside the circumcircle; of a ghost: strictly outside its hull side, or on it.
  bool conflicts(int t, int v) const {
    const int g = ghost_position(t);
    if (g < 0)
      return in_circle(point(corner(t, 0)), point(corner(t, 1)), point(corner(t, 2)), point(v)) > 0;
    const Vec2 &a = point(corner(t, g + 1)), &b = point(corner(t, g + 2)), &q = point(v);
    const int turn = orientation(a, b, q);
    if (turn != 0) return turn > 0;
    // On the line of the side: strictly between its ends, decided along its longer axis.
    const int axis = std::abs(b[0] - a[0]) >= std::abs(b[1] - a[1]) ? 0 : 1;
    return (a[axis] < q[axis] && q[axis] < b[axis]) || (b[axis] < q[axis] && q[axis] < a[axis]);
  }

  /// A triangle in conflict with v, or -1 when v coincides with a corner. The walk ends, since
  /// Delaunay triangles seen along a direction are never ordered in a circle.
  int locate(int v) const {
    const Vec2& q = point(v);
    int t = last_;
    while (true) {
      if (ghost_position(t) >= 0) return t;
      int next = -1;
      for (int s = 0; s < 3 && next < 0; ++s)
        if (orientation(point(corner(t, s)), point(corner(t, s + 1)), q) < 0)
          next = triangle_[at(t)].across[at(s)];
      if (next < 0) break;
      t = next;
    }
    for (int s = 0; s < 3; ++s)
      if (point(corner(t, s)) == q) return -1;
    return t;
  }

  std::span<const Vec2> p_;
  std::vector<Triangle> triangle_;
  std::vector<int> starting_at_, cavity_;
  std::vector<Rim> rim_;
  int last_ = 0;
};

/// The points scaled by a power of two, so that no product of the predicates over- or underflows.
std::vector<Vec2> scaled(std::span<const Vec2> points) {
  double most = 0;
  for (const Vec2& p : points) most = std::max({most, std::abs(p[0]), std::abs(p[1])});
  const int exponent = most > 0 ? std::ilogb(most) : 0;
  std::vector<Vec2> out(points.begin(), points.end());
  for (Vec2& p : out)
    for (int axis = 0; axis < 2; ++axis) p[axis] = std::scalbn(p[axis], -exponent);
  return out;
}

}  // namespace

std::vector<std::array<int, 3>> delaunay(std::span<const Vec2> points) {
  constexpr std::size_t most = std::size_t{1} << 29;
  if (points.size() < 3)
    throw InputError("found " + std::to_string(points.size()) + " points, expected at least 3");
  if (points.size() > most)
    throw InputError("found " + std::to_string(points.size()) + " points, expected at most " +
                     std::to_string(most));
  for (std::size_t i = 0; i < points.size(); ++i)
    for (int axis = 0; axis < 2; ++axis)
      if (!std::isfinite(points[i][axis]))
        throw InputError(InputPlace{{}, 0, "point", static_cast<std::int64_t>(i)},
                         "found " + std::string(1, "xy"[axis]) + " = " +
                             std::to_string(points[i][axis]) + ", expected a finite value");
  const std::vector<Vec2> p = scaled(points);
  std::vector<int> order = insertion_order(p);

  // The first three points that span a triangle.
  const auto fail = [] {
    throw InputError("found points on one line, expected points that span an area");
  };
  const auto second = std::find_if(order.begin() + 1, order.end(),
                                   [&](int v) { return p[at(v)] != p[at(order[0])]; });
  if (second == order.end()) fail();
  std::iter_swap(order.begin() + 1, second);
  const auto turn = [&](int v) { return orientation(p[at(order[0])], p[at(order[1])], p[at(v)]); };
  const auto third =
      std::find_if(order.begin() + 2, order.end(), [&](int v) { return turn(v) != 0; });
  if (third == order.end()) fail();
  std::iter_swap(order.begin() + 2, third);
  if (turn(order[2]) < 0) std::swap(order[0], order[1]);

  Insertion insertion(p);
  insertion.start(order[0], order[1], order[2]);
  for (std::size_t i = 3; i < order.size(); ++i) insertion.insert(order[i]);
  return insertion.take();
}

}  // namespace bezel
