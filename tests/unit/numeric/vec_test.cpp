#include "bezel/numeric/vec.hpp"

#include <gtest/gtest.h>

#include "bezel/numeric/box.hpp"

namespace {

using bezel::Box2;
using bezel::Vec2;
using bezel::Vec3;

TEST(Vec, Arithmetic) {
  const Vec2 a{{1.0, 2.0}}, b{{3.0, -4.0}};
  EXPECT_EQ(a + b, (Vec2{{4.0, -2.0}}));
  EXPECT_EQ(a - b, (Vec2{{-2.0, 6.0}}));
  EXPECT_EQ(-a, (Vec2{{-1.0, -2.0}}));
  EXPECT_EQ(2.0 * a, a * 2.0);
  EXPECT_EQ(dot(a, b), -5.0);
  EXPECT_EQ(cross(a, b), -10.0);
  EXPECT_EQ(cross(b, a), 10.0);
  EXPECT_EQ(norm(b), 5.0);
  EXPECT_EQ(dot(Vec3{{1, 2, 3}}, Vec3{{4, 5, 6}}), 32.0);
}

TEST(Vec, BoxGrowsAndTests) {
  Box2 box;
  EXPECT_TRUE(box.empty());
  EXPECT_EQ(box.diameter(), 0.0);
  box.include(Vec2{{1.0, 1.0}});
  EXPECT_FALSE(box.empty());
  box.include(Vec2{{4.0, 5.0}});
  EXPECT_EQ(box.diameter(), 5.0);
  EXPECT_EQ(box.centre(), (Vec2{{2.5, 3.0}}));
  EXPECT_TRUE(box.contains(Vec2{{4.0, 5.0}}));
  EXPECT_FALSE(box.contains(Vec2{{4.0, 5.1}}));
  Box2 other;
  EXPECT_FALSE(box.overlaps(other));
  other.include(Vec2{{4.0, 0.0}});
  EXPECT_FALSE(box.overlaps(other));
  other.include(Vec2{{4.0, 1.0}});
  EXPECT_TRUE(box.overlaps(other));
  box.include(other);
  EXPECT_EQ(box.lo, (Vec2{{1.0, 0.0}}));
}

TEST(Vec, AGrownBoxOverlapsWhatIsNear) {
  Box2 box;
  EXPECT_TRUE(grown(box, 1.0).empty());
  box.include(Vec2{{1.0, 2.0}});
  box.include(Vec2{{3.0, 7.0}});
  const Box2 larger = grown(box, 0.25);
  EXPECT_EQ(larger.lo, (Vec2{{0.75, 1.75}}));
  EXPECT_EQ(larger.hi, (Vec2{{3.25, 7.25}}));
  EXPECT_EQ(grown(box, 0.0).lo, box.lo);
  EXPECT_EQ(grown(box, 0.0).hi, box.hi);
  EXPECT_EQ(grown(box, -0.5).hi, (Vec2{{2.5, 6.5}}));
  Box2 beside;
  beside.include(Vec2{{3.2, 3.0}});
  EXPECT_FALSE(box.overlaps(beside));
  EXPECT_TRUE(larger.overlaps(beside));
}

}  // namespace
