#include "bezel/view/label_placer.hpp"

#include <gtest/gtest.h>

#include <array>

#include "bezel/base/random.hpp"

namespace bezel::view {
namespace {

Box2 box_of(const Vec2& lo, const Vec2& hi) {
  Box2 box;
  box.include(lo);
  box.include(hi);
  return box;
}

const Box2 frame = box_of(Vec2{{0, 0}}, Vec2{{400, 300}});
const Vec2 size{{20, 12}};

Box2 label(const LabelPlacer::Place& place) {
  return box_of(place.centre - 0.5 * size, place.centre + 0.5 * size);
}

TEST(LabelPlacer, TakesTheFirstDirectionWhereThereIsRoom) {
  LabelPlacer placer(frame);
  const LabelPlacer::Place place = placer.place(Vec2{{200, 150}}, size, 5.0);
  EXPECT_FALSE(place.far);
  EXPECT_GT(place.centre.x(), 200.0);  // up to the right
  EXPECT_LT(place.centre.y(), 150.0);
  EXPECT_FALSE(label(place).contains(Vec2{{200, 150}}));
}

TEST(LabelPlacer, StaysInTheFrame) {
  for (const Vec2& corner :
       {Vec2{{0, 0}}, Vec2{{400, 0}}, Vec2{{0, 300}}, Vec2{{400, 300}}, Vec2{{200, 0}}}) {
    LabelPlacer placer(frame);
    const Box2 box = label(placer.place(corner, size, 5.0));
    EXPECT_TRUE(frame.contains(box.lo) && frame.contains(box.hi))
        << corner.x() << " " << corner.y();
  }
}

TEST(LabelPlacer, KeepsOffLines) {
  // Along a falling diagonal; the other two quarters are free.
  LabelPlacer placer(frame);
  placer.avoid(std::array{Vec2{{50, 250}}, Vec2{{350, 50}}});
  const Box2 box = label(placer.place(Vec2{{200, 150}}, size, 5.0));
  for (int k = 0; k <= 1000; ++k)
    EXPECT_FALSE(box.contains(Vec2{{50.0 + 0.3 * k, 250.0 - 0.2 * k}}));
}

TEST(LabelPlacer, LabelsOfACrowdDoNotOverlap) {
  LabelPlacer placer(frame);
  RandomStream random("label crowd", 1);
  std::vector<Vec2> points;
  for (int i = 0; i < 30; ++i)
    points.push_back(Vec2{{20.0 + 360.0 * random.uniform(), 20.0 + 260.0 * random.uniform()}});
  for (const Vec2& p : points) placer.avoid(p, 5.0);
  std::vector<Box2> labels;
  for (const Vec2& p : points) labels.push_back(label(placer.place(p, size, 6.0)));
  int overlaps = 0;
  for (std::size_t i = 0; i < labels.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) overlaps += labels[i].overlaps(labels[j]) ? 1 : 0;
  EXPECT_EQ(overlaps, 0);
}

TEST(LabelPlacer, SomewhereEvenWhenAllIsCovered) {
  LabelPlacer placer(frame);
  for (int y = 0; y <= 300; y += 3)
    placer.avoid(std::array{Vec2{{0.0, double(y)}}, Vec2{{400.0, double(y)}}});
  const LabelPlacer::Place place = placer.place(Vec2{{200, 150}}, size, 5.0);
  EXPECT_LT(norm(place.centre - Vec2{{200, 150}}), 60.0);
}

TEST(LabelPlacer, RoomAtSidePrefersCornersThenSides) {
  const Vec2 box{{100, 60}};
  LabelPlacer placer(frame);
  EXPECT_EQ(placer.room_at_side(box, 10.0, 5.0).corner, (Vec2{{290, 10}}));
  placer.avoid(std::array{Vec2{{380, 20}}});
  EXPECT_EQ(placer.room_at_side(box, 10.0, 5.0).corner, (Vec2{{10, 10}}));
  for (const Vec2& p : {Vec2{{20, 20}}, Vec2{{20, 280}}, Vec2{{380, 280}}})
    placer.avoid(std::array{p});
  const LabelPlacer::Room side = placer.room_at_side(box, 10.0, 5.0);
  EXPECT_EQ(side.corner, (Vec2{{290, 120}}));
  EXPECT_FALSE(side.covered);
  // A cross, and all that is left is between a corner and the middle of a side.
  LabelPlacer crossed(frame);
  crossed.avoid(std::array{Vec2{{0, 150}}, Vec2{{400, 150}}});
  crossed.avoid(std::array{Vec2{{200, 0}}, Vec2{{200, 300}}});
  for (const Vec2& p : {Vec2{{12, 12}}, Vec2{{388, 12}}, Vec2{{12, 288}}, Vec2{{388, 288}}})
    crossed.avoid(std::array{p});
  const LabelPlacer::Room between = crossed.room_at_side(box, 10.0, 5.0);
  EXPECT_FALSE(between.covered);
  EXPECT_NE(between.corner.x(), 10.0);
}

// Whatever the lines: a place that covers nothing is said to, and holds no point of them.
TEST(LabelPlacer, RoomAtSideCoversNoLineUnlessItSaysSo) {
  RandomStream random("room at side", 1);
  const Vec2 box{{130, 90}};
  int clear = 0, covered = 0;
  for (int run = 0; run < 200; ++run) {
    LabelPlacer placer(frame);
    std::vector<Vec2> line;
    for (int i = 0; i < 2 + run / 20; ++i)
      line.push_back(Vec2{{400.0 * random.uniform(), 300.0 * random.uniform()}});
    placer.avoid(line);
    const LabelPlacer::Room room = placer.room_at_side(box, 10.0, 5.0);
    const Box2 place = box_of(room.corner, room.corner + box);
    EXPECT_TRUE(frame.contains(place.lo) && frame.contains(place.hi));
    ++(room.covered ? covered : clear);
    if (room.covered) continue;
    for (std::size_t i = 1; i < line.size(); ++i)
      for (int k = 0; k <= 500; ++k)
        ASSERT_FALSE(place.contains(line[i - 1] + (k / 500.0) * (line[i] - line[i - 1]))) << run;
  }
  EXPECT_GT(clear, 20);
  EXPECT_GT(covered, 20);
}

}  // namespace
}  // namespace bezel::view
