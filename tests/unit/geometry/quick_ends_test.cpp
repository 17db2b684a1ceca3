#include "bezel/geometry/quick_ends.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "bezel/base/random.hpp"
#include "bezel/bernstein/interval.hpp"

namespace bezel::geometry_kernel {
namespace {

constexpr double distance = 1e-13;

EndMeeting meet(const std::vector<Vec2>& a, const std::vector<Vec2>& b, QuickEnds& out) {
  return meet_at_ends(cache_curve(a), cache_curve(b), distance, out);
}

std::vector<Vec2> reversed(std::vector<Vec2> p) {
  std::reverse(p.begin(), p.end());
  return p;
}

/// The part of a curve from s to t.
std::vector<Vec2> part(const std::vector<Vec2>& p, double s, double t) {
  const std::size_t d = p.size() - 1;
  std::vector<Vec2> out;
  for (std::size_t k = 0; k <= d; ++k) {
    std::vector<Vec2> q = p;
    for (std::size_t level = 0; level < d; ++level) {
      const double x = level < d - k ? s : t;
      for (std::size_t i = 0; i + level < d; ++i) q[i] = (1.0 - x) * q[i] + x * q[i + 1];
    }
    out.push_back(q[0]);
  }
  return out;
}

std::vector<Vec2> edge(RandomStream& random, std::size_t degree, const Vec2& from, const Vec2& to) {
  std::vector<Vec2> p;
  const double bend = 0.1 / double(degree) * norm(to - from);
  for (std::size_t i = 0; i <= degree; ++i) {
    p.push_back(from + (to - from) * (double(i) / double(degree)));
    if (i > 0 && i < degree)
      p.back() += bend * Vec2{{random.uniform(-1, 1), random.uniform(-1, 1)}};
  }
  p.front() = from;
  p.back() = to;
  return p;
}

Vec2 somewhere(RandomStream& random) {
  return {{random.uniform(-1, 1), random.uniform(-1, 1)}};
}

/// What is decided is what the search finds with the same distance.
void expect_as_found(const std::vector<Vec2>& a, const std::vector<Vec2>& b, int& decided) {
  QuickEnds quick{};
  const EndMeeting meeting = meet(a, b, quick);
  if (meeting == EndMeeting::unclear) return;
  ++decided;
  IntersectOptions options;
  options.coincidence_distance = distance;
  const CurveIntersections found = intersect(a, b, options);
  ASSERT_TRUE(found.tangencies.empty() && found.unresolved.empty());
  if (meeting == EndMeeting::point) {
    ASSERT_TRUE(found.overlaps.empty());
    ASSERT_EQ(found.crossings.size(), 1U);
    EXPECT_EQ(quick.s, found.crossings[0].s);
    EXPECT_EQ(quick.t, found.crossings[0].t);
    EXPECT_LE(quick.gap, distance);
    return;
  }
  ASSERT_TRUE(found.crossings.empty());
  ASSERT_EQ(found.overlaps.size(), 1U);
  const Overlap& overlap = found.overlaps[0];
  EXPECT_EQ(quick.s, overlap.s0);
  EXPECT_EQ(quick.s_end, overlap.s1);
  EXPECT_EQ(quick.t, overlap.t0);
  EXPECT_EQ(quick.t_end, overlap.t1);
  EXPECT_NEAR(quick.gap, overlap.gap, 1e-15);
}

TEST(QuickEnds, StraightEdges) {
  QuickEnds e{};
  const std::vector<Vec2> a = {{{0, 0}}, {{2, 0}}};
  EXPECT_EQ(meet(a, {{{2, 0}}, {{2, 3}}}, e), EndMeeting::point);  // a common vertex
  EXPECT_EQ(e.s, 1.0);
  EXPECT_EQ(e.t, 0.0);
  EXPECT_EQ(meet(a, {{{5, 0}}, {{2, 0}}}, e), EndMeeting::point);  // going on straight
  EXPECT_EQ(e.s, 1.0);
  EXPECT_EQ(e.t, 1.0);
  EXPECT_EQ(meet(a, {{{1, 1}}, {{0.5, 0}}}, e), EndMeeting::point);  // an end on the edge
  EXPECT_EQ(e.s, 0.25);
  EXPECT_EQ(e.t, 1.0);
  EXPECT_EQ(meet(a, reversed(a), e), EndMeeting::part);
  EXPECT_EQ(e.t, 1.0);
  EXPECT_EQ(e.t_end, 0.0);
  EXPECT_EQ(meet(a, {{{3, 0}}, {{1, 0}}}, e), EndMeeting::part);
  EXPECT_EQ(e.s, 0.5);
  EXPECT_EQ(e.t, 1.0);
  EXPECT_EQ(e.s_end, 1.0);
  EXPECT_EQ(e.t_end, 0.5);
}

TEST(QuickEnds, LeavesTheRestToTheSearch) {
  QuickEnds e{};
  const std::vector<Vec2> a = {{{0, 0}}, {{2, 0}}}, point = {{{0, 0}}, {{0, 0}}};
  EXPECT_EQ(meet(a, {{{0, 0}}, {{2, 1e-3}}}, e), EndMeeting::unclear);   // a small angle
  EXPECT_EQ(meet(a, {{{1, -1}}, {{1, 1}}}, e), EndMeeting::unclear);     // no end
  EXPECT_EQ(meet(a, {{{1, 1e-12}}, {{1, 1}}}, e), EndMeeting::unclear);  // not near enough
  EXPECT_EQ(meet(a, point, e), EndMeeting::unclear);
  EXPECT_EQ(meet(point, point, e), EndMeeting::unclear);
  // The second turns back to the vertex, the third meets the edge there and once more.
  EXPECT_EQ(meet({{{0, 0}}, {{1, 1}}, {{0, 0}}}, {{{0, 0}}, {{0, 1}}, {{0, 2}}}, e),
            EndMeeting::unclear);
  EXPECT_EQ(meet({{{0, 0}}, {{1, 0}}, {{2, 0}}}, {{{0, 0}}, {{1, 0.5}}, {{2, -0.5}}}, e),
            EndMeeting::unclear);
}

TEST(QuickEnds, AgreeWithTheSearchInCommonVertices) {
  for (std::size_t degree = 1; degree <= 4; ++degree) {
    RandomStream random("quick ends vertex", degree);
    int decided = 0;
    const int runs = 1000;
    for (int run = 0; run < runs; ++run) {
      const Vec2 vertex = somewhere(random);
      std::vector<Vec2> a = edge(random, degree, vertex, somewhere(random));
      std::vector<Vec2> b = edge(random, 1 + degree % 3, vertex, somewhere(random));
      if (random.uniform() < 0.5) a = reversed(a);
      if (random.uniform() < 0.5) b = reversed(b);
      ASSERT_NO_FATAL_FAILURE(expect_as_found(a, b, decided)) << degree << " run " << run;
    }
    EXPECT_GT(decided, 7 * runs / 10) << degree;
  }
}

TEST(QuickEnds, AgreeWithTheSearchOnEdges) {
  for (std::size_t degree = 1; degree <= 4; ++degree) {
    RandomStream random("quick ends edge", degree);
    int decided = 0;
    const int runs = 500;
    for (int run = 0; run < runs; ++run) {
      std::vector<Vec2> a = edge(random, degree, somewhere(random), somewhere(random));
      const Vec2 on = bernstein::evaluate<Vec2>(a, random.uniform());
      std::vector<Vec2> b = edge(random, degree, on, somewhere(random));
      if (random.uniform() < 0.5) std::swap(a, b);
      ASSERT_NO_FATAL_FAILURE(expect_as_found(a, b, decided)) << degree << " run " << run;
    }
    EXPECT_GT(decided, runs / 2) << degree;
  }
}

TEST(QuickEnds, AgreeWithTheSearchOnCommonParts) {
  for (std::size_t degree = 1; degree <= 4; ++degree) {
    RandomStream random("quick ends part", degree);
    int decided = 0;
    const int runs = 500;
    for (int run = 0; run < runs; ++run) {
      const std::vector<Vec2> whole = edge(random, degree, somewhere(random), somewhere(random));
      const bool same = run % 2 == 0;
      const double x = same ? 0.0 : random.uniform(), y = same ? 1.0 : random.uniform();
      std::vector<Vec2> a = part(whole, 0.0, same ? 1.0 : 0.7);
      std::vector<Vec2> b = part(whole, std::min(x, y), std::max(x, y));
      if (random.uniform() < 0.5) b = reversed(b);
      ASSERT_NO_FATAL_FAILURE(expect_as_found(a, b, decided)) << degree << " run " << run;
    }
    EXPECT_GT(decided, degree == 1 ? runs * 8 / 10 : runs * 4 / 10) << degree;
  }
}

}  // namespace
}  // namespace bezel::geometry_kernel
