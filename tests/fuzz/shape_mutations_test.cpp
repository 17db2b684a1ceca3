// The JSON that intersect reads: the three forms, places of errors, and seeded mutations of valid
// texts.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/base/random.hpp"
#include "bezel/bernstein/index.hpp"
#include "cli/shapes.hpp"
#include "text_mutations.hpp"

namespace bezel::cli {
namespace {

const std::vector<std::string> seeds = {
    "{\"curves\": [\n {\"control\": [[0, \"1/2\"], [1e0, \"0x1.8p-1\"], [2, -1]],\n  \"name\": "
    "\"c\"},"
    "\n {\"control\": [[0, 0]], \"degree\": 0}]}",
    "{\"triangles\": [{\"control\": [[0, 0], [1, 0], [0, 1]]},\n {\"degree\": 2, \"control\": [[0, "
    "0], [1, 0], [2, 0], [0, 1], [1, 1], [0, 2]]}]}",
    "{\"pairs\": [{\"a\": {\"curve\": [[0, 1], [0, 1]]}, \"b\": {\"curve\": [[0], [0]]}},\n "
    "{\"a\": "
    "{\"triangle\": [[0, 1, 0], [0, 0, 1]]}, \"b\": {\"triangle\": [[0, 1, 0], [0, 0, 1]]}}]}",
    "{\"a\": {\"curve\": [[0, 1], [0, 1]], \"name\": \"x\"}, \"b\": {\"curve\": [[0], [0]]}}"};

TEST(Shapes, AllForms) {
  const Shapes curves = read_shapes("f", seeds[0]);
  ASSERT_EQ(curves.shapes.size(), 2U);
  EXPECT_EQ(curves.shapes[0].control,
            (std::vector<Vec2>{Vec2{{0, 0.5}}, Vec2{{1, 0.75}}, Vec2{{2, -1}}}));
  EXPECT_EQ(curves.shapes[0].degree, 2);
  EXPECT_EQ(curves.shapes[0].name, "c");
  EXPECT_EQ(curves.shapes[1].name, "curve 1");
  EXPECT_EQ(curves.pairs, (std::vector<std::pair<std::size_t, std::size_t>>{{0, 1}}));
  EXPECT_FALSE(curves.in_pairs);
  const Shapes triangles = read_shapes("f", seeds[1]);
  EXPECT_TRUE(triangles.shapes[0].triangle);
  EXPECT_EQ(triangles.shapes[0].degree, 1);
  EXPECT_EQ(triangles.shapes[1].degree, 2);
  const Shapes pairs = read_shapes("f", seeds[2]);
  EXPECT_TRUE(pairs.in_pairs);
  EXPECT_EQ(pairs.pairs, (std::vector<std::pair<std::size_t, std::size_t>>{{0, 1}, {2, 3}}));
  EXPECT_TRUE(pairs.shapes[2].triangle);
  EXPECT_EQ(pairs.shapes[3].control[1], (Vec2{{1, 0}}));
  const Shapes pair = read_shapes("f", seeds[3]);
  EXPECT_EQ(pair.pairs.size(), 1U);
  EXPECT_EQ(pair.shapes[0].name, "x");
  EXPECT_EQ(pair.shapes[1].name, "b");
}

TEST(Shapes, OneCurveHasNoPairsAndManyHaveAll) {
  EXPECT_TRUE(read_shapes("f", "{\"curves\": [{\"control\": [[0, 0], [1, 1]]}]}").pairs.empty());
  const auto many = [](std::size_t n) {
    std::string json = "{\"curves\": [";
    for (std::size_t i = 0; i < n; ++i)
      json += i == 0 ? "" : ",", json += "{\"control\": [[0, 0]]}";
    return json + "]}";
  };
  EXPECT_EQ(read_shapes("f", many(most_shapes)).pairs.size(), most_shapes * (most_shapes - 1) / 2);
  EXPECT_THROW(read_shapes("f", many(most_shapes + 1)), InputError);
}

TEST(Shapes, DegreesFollowFromTheCount) {
  for (int d = 0; d <= bernstein::max_interval_degree; ++d) {
    std::string json = "{\"curves\": [{\"control\": [[0, 0]";
    for (int i = 0; i < d; ++i) json += ", [1, 2]";
    EXPECT_EQ(read_shapes("f", json + "]}]}").shapes[0].degree, d);
  }
  for (int n = 1; n <= bernstein::triangle_size(bernstein::max_triangle_degree) + 1; ++n) {
    std::string triangle = "{\"control\": [[0, 0]";
    for (int i = 1; i < n; ++i) triangle += ", [1, 2]";
    triangle += "]}";
    const std::string json = "{\"triangles\": [" + triangle + ", " + triangle + "]}";
    int degree = 1;
    while (bernstein::triangle_size(degree) < n) ++degree;
    if (degree <= bernstein::max_triangle_degree && bernstein::triangle_size(degree) == n) {
      EXPECT_EQ(read_shapes("f", json).shapes[1].degree, degree);
    } else {
      EXPECT_THROW(read_shapes("f", json), InputError) << n;
    }
  }
}

/// @return whether it was read; test::read_or_refused
bool read(const std::string& json) {
  return test::read_or_refused([&] {
    const Shapes all = read_shapes("fuzz.json", json);
    if (all.shapes.empty()) throw std::logic_error("nothing was read");
    for (const Shape& shape : all.shapes) {
      if (static_cast<int>(shape.control.size()) !=
          bernstein::simplex_size(shape.triangle ? 2 : 1, shape.degree))
        throw std::logic_error("a wrong degree");
      for (const Vec2& p : shape.control)
        if (!std::isfinite(p.x()) || !std::isfinite(p.y()))
          throw std::logic_error("a number that is not finite");
    }
    for (const auto& [a, b] : all.pairs)
      if (a >= all.shapes.size() || b >= all.shapes.size() ||
          all.shapes[a].triangle != all.shapes[b].triangle)
        throw std::logic_error("a wrong pair");
  });
}

TEST(ShapeMutations, EveryTruncationIsRefused) {
  for (const std::string& seed : seeds) {
    EXPECT_TRUE(read(seed));
    for (std::size_t n = 0; n < seed.size(); ++n) EXPECT_FALSE(read(seed.substr(0, n))) << n;
  }
}

TEST(ShapeMutations, MutatedTextsAreReadOrRefused) {
  const std::vector<std::string> words = {"null",
                                          "true",
                                          "1e999",
                                          "\"1/0\"",
                                          "[",
                                          "]",
                                          "{",
                                          "}",
                                          ",",
                                          ":",
                                          "\"",
                                          "\\u0000",
                                          "\"\"",
                                          "\"nan\"",
                                          "-",
                                          "0x",
                                          "\n",
                                          "1e-999",
                                          "\xff",
                                          "\"a\":",
                                          "\"degree\":2",
                                          "\"curve\":",
                                          "[[0],[0]]",
                                          "18446744073709551616",
                                          "[0, 0]",
                                          "\"name\":",
                                          "\"curves\":",
                                          "\"control\":",
                                          "{}",
                                          "[[[[[[[[[[[[[[[["};
  test::try_mutations("shape mutations", 60000, seeds, words, read);
}

// A name of any bytes; brackets without end.
TEST(ShapeMutations, HostileTexts) {
  EXPECT_EQ(
      read_shapes("f", "{\"curves\": [{\"control\": [[0, 0]], \"name\": \"a\\u0007\\n<&>\"}]}")
          .shapes[0]
          .name,
      "a?\?<&>");
  EXPECT_FALSE(read(std::string(1000000, '[')));
  EXPECT_FALSE(read("{\"curves\": " + std::string(1000000, '[')));
  std::string keys = "{\"k0\": 0";
  for (int i = 1; i < 100000; ++i) keys += ", \"k" + std::to_string(i) + "\": 0";
  EXPECT_FALSE(read(keys + "}"));
}

}  // namespace
}  // namespace bezel::cli
