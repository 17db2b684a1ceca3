// `isolate` against exact elimination.

#include "bezel/geometry/isolate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "bezel/base/random.hpp"
#include "support/curve_oracle.hpp"
#include "support/curve_pairs.hpp"
#include "support/isolation_verdict.hpp"

namespace {

using bezel::RandomStream;
using bezel::geometry_kernel::Isolation;
using support::CurvePair;

struct Tally {
  int runs = 0, undecided = 0, roots = 0, with_open = 0;  // with open boxes of no sign
  std::size_t most_open = 0;
  double worst_error = 0;
};

Isolation isolated(const CurvePair& pair) {
  Isolation out;
  bezel::geometry_kernel::isolate(pair.a, pair.b, out);
  return out;
}
support::CommonParts truth_of(const CurvePair& pair) {
  return support::common_parts(support::rational_points(pair.a), support::rational_points(pair.b));
}

void run(Tally& tally, const CurvePair& pair, const std::string& variant) {
  const Isolation found = isolated(pair);
  const auto verdict = support::judge_isolation(pair, truth_of(pair), found);
  EXPECT_EQ(verdict.wrong, "") << pair.name << variant;
  ++tally.runs;
  tally.undecided += verdict.undecided ? 1 : 0;
  tally.roots += static_cast<int>(found.roots.size());
  const auto open = static_cast<std::size_t>(std::count_if(
      found.open.begin(), found.open.end(), [](const auto& o) { return o.sign == 0; }));
  tally.with_open += open > 0 ? 1 : 0;
  tally.most_open = std::max(tally.most_open, open);
  tally.worst_error = std::max(tally.worst_error, verdict.worst_error);
}

void run_variants(Tally& tally, const CurvePair& pair, RandomStream& random) {
  run(tally, pair, "");
  run(tally, exchanged(pair), " | exchanged");
  run(tally, with_first_reversed(pair), " | reversed");
  for (const int e : {-300, static_cast<int>(random.below(501)) - 300})
    run(tally, scaled(pair, e), support::numbered(" | times 2^", e));
  for (const int x : {1, 20})
    if (const auto far = exactly_mapped(pair, support::translation(1 << x, 3 << x)))
      run(tally, *far, support::numbered(" | moved by 2^", x));
  for (int i = 0; i < 3; ++i) {
    if (const auto image = exactly_mapped(pair, support::random_dyadic_map(random)))
      run(tally, *image, support::numbered(" | dyadic map ", i));
    run(tally, roughly_mapped(pair, support::random_map(random)), support::numbered(" | map ", i));
  }
}

class IsolateHardPairs : public testing::Test {
 protected:
  void run_all(const std::string& name, const std::vector<CurvePair>& pairs) {
    RandomStream random("Isolate." + name, 1);
    for (const CurvePair& pair : pairs) run_variants(tally, pair, random);
    EXPECT_LE(tally.worst_error, 4.0);
    EXPECT_LE(tally.undecided, tally.runs / 10);
  }
  Tally tally;
};

TEST_F(IsolateHardPairs, NineHits) {
  run_all("NineHits", support::nine_hits());
  EXPECT_EQ(tally.with_open, 0);
}
TEST_F(IsolateHardPairs, NearTangents) {
  run_all("NearTangents", support::near_tangents());
  EXPECT_LE(tally.most_open, 16U);
}
TEST_F(IsolateHardPairs, Contacts) {
  run_all("Contacts", support::contacts());
  EXPECT_EQ(tally.roots, 0);
  EXPECT_LE(tally.most_open, 16U);
}
TEST_F(IsolateHardPairs, Sheared) {
  run_all("Sheared", support::sheared());
  EXPECT_LE(tally.most_open, 100U);
}
TEST_F(IsolateHardPairs, Overlaps) {
  run_all("Overlaps", support::overlaps());
  EXPECT_LE(tally.most_open, 100U);
}
TEST_F(IsolateHardPairs, SingularAndEnds) {
  run_all("SingularAndEnds", support::singular_and_ends());
}

template <class Draw>
Tally run_random(const std::string& name, int count, Draw draw) {
  RandomStream random("Isolate." + name, 1);
  Tally tally;
  for (int i = 0; i < count; ++i) {
    CurvePair pair = draw(random, i);
    pair.name = name;
    run(tally, pair, support::numbered(" ", i));
  }
  EXPECT_LE(tally.worst_error, 4.0) << name;
  EXPECT_GT(tally.roots, 0) << name;
  return tally;
}

TEST(IsolateRandomPairs, Cubics) {
  const Tally tally = run_random("cubics", 600, [](RandomStream& random, int) {
    return CurvePair{"", support::random_curve(random, 3), support::random_curve(random, 3)};
  });
  EXPECT_EQ(tally.with_open, 0);
}

TEST(IsolateRandomPairs, CubicsFarOff) {
  const Tally tally = run_random("cubics far off", 200, [](RandomStream& random, int) {
    const CurvePair pair{"", support::coarse_random_curve(random, 3, 28),
                         support::coarse_random_curve(random, 3, 28)};
    return exactly_mapped(pair, support::translation(1 << 20, 3 << 20)).value();
  });
  EXPECT_EQ(tally.with_open, 0);
}

// Control points on few places: roots at ends, on borders of boxes, collinear and equal points.
TEST(IsolateRandomPairs, CoarseControlPoints) {
  run_random("coarse", 1000, [](RandomStream& random, int i) {
    return CurvePair{"", support::coarse_random_curve(random, 1 + i % 3, 2 + i % 2),
                     support::coarse_random_curve(random, 1 + i / 3 % 3, 2)};
  });
}

TEST(IsolateRandomPairs, NearlyTheSame) {
  run_random("jitter", 300, [](RandomStream& random, int i) {
    const auto c = support::random_curve(random, 3);
    return CurvePair{"", c, support::jittered(c, random, 5 + i % 50)};
  });
}

TEST(IsolateRandomPairs, Joints) {
  run_random("joints", 300, [](RandomStream& random, int i) {
    return support::random_joint(random, 1 + i % 4, i % 3 == 0);
  });
}

TEST(IsolateRandomPairs, DegreesOneToSix) {
  for (int m = 1; m <= 6; ++m)
    for (int n = 1; n <= 6; ++n)
      run_random("degrees" + support::numbered(" ", m) + support::numbered(" ", n),
                 m * n > 12 ? 8 : 30, [&](RandomStream& random, int) {
                   return CurvePair{"", support::random_curve(random, m),
                                    support::random_curve(random, n)};
                 });
}

// The judge itself: a right answer made wrong is noticed.
TEST(IsolationVerdict, NoticesEveryKindOfError) {
  const CurvePair nine = support::nine_hits().back(), touching = support::contacts().front();
  const CurvePair overlap = support::overlaps().front();
  const CurvePair end{"", {{{0, 0}}, {{4, 0}}}, {{{1, 0}}, {{1, 1}}, {{2, 3}}}};
  const auto wrong = [](const CurvePair& pair, auto change) {
    Isolation found = isolated(pair);
    EXPECT_EQ(judge_isolation(pair, truth_of(pair), found).wrong, "");
    change(found);
    return judge_isolation(pair, truth_of(pair), found).wrong;
  };
  EXPECT_EQ(wrong(nine, [](Isolation& x) { x.roots.pop_back(); }), "a point missed");
  EXPECT_EQ(wrong(nine, [](Isolation& x) { x.roots.push_back(x.roots[3]); }),
            "a point in two roots' boxes");
  EXPECT_EQ(wrong(nine, [](Isolation& x) { x.roots[3].sign *= -1; }), "the sign of a root");
  EXPECT_EQ(wrong(nine,
                  [](Isolation& x) {
                    x.roots.push_back({0.3, 0.3, 0.29, 0.31, 0.29, 0.31, 1});
                  }),
            "a root made up");
  EXPECT_EQ(wrong(nine, [](Isolation& x) { x.roots[3].s = x.roots[3].s_hi + 0.1; }),
            "a root's box");
  EXPECT_EQ(wrong(touching, [](Isolation& x) { x.open.clear(); }), "a point missed");
  EXPECT_EQ(wrong(touching,
                  [](Isolation& x) {
                    x.open.clear();
                    x.roots.push_back({0.5, 0.5, 0.4, 0.6, 0.4, 0.6, 1});
                  }),
            "a root that is not simple, the sign of a root");
  EXPECT_EQ(wrong(overlap, [](Isolation& x) { x.open.clear(); }), "a common part missed");
  EXPECT_EQ(wrong(end, [](Isolation& x) { x.open[0].sign = -1; }), "the sign of an open box");
}

}  // namespace
