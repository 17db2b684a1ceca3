#include "bezel/mesh/generate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "bezel/base/error.hpp"
#include "support/message_of.hpp"
#include "unit/mesh/mesh_checks.hpp"

namespace bezel {
namespace {

using test::message_of;

using namespace test;

constexpr double pi = 3.141592653589793;

GenerateOptions with(Pattern pattern, int degree, double size, std::uint64_t seed = 1) {
  GenerateOptions options;
  options.pattern = pattern;
  options.degree = degree;
  options.size = size;
  options.seed = seed;
  options.centre = Vec2{{0.3, -0.7}};
  return options;
}

class EveryPattern : public testing::TestWithParam<Pattern> {};
INSTANTIATE_TEST_SUITE_P(Generate, EveryPattern,
                         testing::Values(Pattern::structured, Pattern::unstructured),
                         [](const auto& p) {
                           return p.param == Pattern::structured ? "structured" : "unstructured";
                         });

TEST_P(EveryPattern, RectangleIsExactAndTagged) {
  for (const int g : {1, 2, 5, 10}) {
    const auto mesh = generate_rectangle(1.3, 0.7, with(GetParam(), g, 0.2));
    expect_consistent(mesh);
    expect_all_valid(mesh);
    EXPECT_EQ(euler(mesh), 1);
    EXPECT_NEAR(total_area(mesh), 1.3 * 0.7, 1e-14);
    EXPECT_EQ(mesh.box().lo, (Vec2{{0.3 - 0.65, -0.7 - 0.35}}));
    EXPECT_EQ(mesh.box().hi, (Vec2{{0.3 + 0.65, -0.7 + 0.35}}));
    const auto length = boundary_lengths(mesh);
    EXPECT_EQ(length.size(), 4u);
    for (const char* name : {"bottom", "top"}) EXPECT_NEAR(length.at(name), 1.3, 1e-13) << name;
    for (const char* name : {"left", "right"}) EXPECT_NEAR(length.at(name), 0.7, 1e-13) << name;
    // Straight sides are straight to the last bit.
    for (const TaggedEdge& edge : mesh.tags().edges)
      for (const NodeId n : edge.nodes) {
        const Vec2& p = mesh.control(n);
        EXPECT_TRUE(p[0] == mesh.box().lo[0] || p[0] == mesh.box().hi[0] ||
                    p[1] == mesh.box().lo[1] || p[1] == mesh.box().hi[1]);
      }
  }
}

TEST_P(EveryPattern, SidesOfTheRectangleLieWhereTheirNamesSay) {
  const auto mesh = generate_rectangle(2, 1, with(GetParam(), 1, 0.5));
  const std::array<std::string, 4> names{"bottom", "right", "top", "left"};
  for (const TaggedEdge& edge : mesh.tags().edges) {
    const Vec2 mid =
        0.5 * (mesh.control(edge.nodes[0]) + mesh.control(edge.nodes[1])) - Vec2{{0.3, -0.7}};
    const std::string place = mid[1] < -0.49  ? "bottom"
                              : mid[0] > 0.99 ? "right"
                              : mid[1] > 0.49 ? "top"
                                              : "left";
    EXPECT_EQ(names[static_cast<std::size_t>(edge.entity - 1)], place);
  }
}

TEST_P(EveryPattern, LShape) {
  for (const int g : {1, 3}) {
    const auto mesh = generate_lshape(2, with(GetParam(), g, 0.3));
    expect_consistent(mesh);
    expect_all_valid(mesh);
    EXPECT_EQ(euler(mesh), 1);
    EXPECT_NEAR(total_area(mesh), 3, 1e-13);
    EXPECT_NEAR(boundary_lengths(mesh).at("boundary"), 8, 1e-12);
    // Nothing in the lower right quarter.
    for (const Vec2& p : mesh.control()) EXPECT_TRUE(p[0] <= 0.3 || p[1] >= -0.7);
  }
}

TEST_P(EveryPattern, DiscAndAnnulusAreValidAndTagged) {
  for (const int g : {1, 2, 3, 4, 7, 10}) {
    const auto disc = generate_disc(0.8, with(GetParam(), g, 0.3));
    expect_consistent(disc);
    expect_all_valid(disc);
    EXPECT_EQ(euler(disc), 1);
    const auto annulus = generate_annulus(0.4, 1.1, with(GetParam(), g, 0.3));
    expect_consistent(annulus);
    expect_all_valid(annulus);
    EXPECT_EQ(euler(annulus), 0);
    if (g == 1) continue;
    EXPECT_NEAR(boundary_lengths(disc).at("boundary"), 2 * pi * 0.8, 2e-3);
    EXPECT_NEAR(boundary_lengths(annulus).at("inner"), 2 * pi * 0.4, 2e-3);
    EXPECT_NEAR(boundary_lengths(annulus).at("outer"), 2 * pi * 1.1, 4e-3);
  }
}

// Angle per boundary edge: halving it must divide the area error by 2^(2g).
TEST_P(EveryPattern, DiscAreaConvergesAtTwiceTheDegree) {
  for (const int g : {1, 2, 3, 4}) {
    const auto error = [&](double size) {
      const auto mesh = generate_disc(1, with(GetParam(), g, size));
      return std::abs(total_area(mesh) - pi) / pi;
    };
    // Sizes that give 12 and 24 boundary edges in both patterns.
    const double coarse = error(0.5), fine = error(0.25),
                 n = GetParam() == Pattern::structured ? 2 : 25.0 / 13;
    EXPECT_NEAR(std::log(coarse / fine) / std::log(n), 2 * g, 0.1)
        << g << ' ' << coarse << ' ' << fine;
  }
}

TEST_P(EveryPattern, BoundaryLiesOnTheCircleToOrderDegreePlusOne) {
  for (const int g : {1, 2, 3, 5}) {
    const auto error = [&](double size) {
      const auto mesh = generate_disc(1, with(GetParam(), g, size));
      double worst = 0;
      for (const TaggedEdge& edge : mesh.tags().edges) {
        std::vector<Vec2> curve;
        for (const NodeId n : edge.nodes) curve.push_back(mesh.control(n));
        EXPECT_NEAR(norm(curve.front() - Vec2{{0.3, -0.7}}), 1, 4e-16);
        for (int i = 0; i <= 20; ++i)
          worst = std::max(
              worst,
              std::abs(norm(bernstein::evaluate<Vec2>(curve, i / 20.0) - Vec2{{0.3, -0.7}}) - 1));
      }
      return worst;
    };
    const double n = GetParam() == Pattern::structured ? 2 : 25.0 / 13;  // more boundary edges
    EXPECT_GT(std::log(error(0.5) / error(0.25)) / std::log(n), g + 1 - 0.1) << g;
  }
}

TEST_P(EveryPattern, SizesAndShapesOfTriangles) {
  for (const double size : {0.3, 0.1, 0.04}) {
    for (const auto& mesh : {generate_rectangle(1, 1, with(GetParam(), 1, size)),
                             generate_disc(0.5, with(GetParam(), 1, size)),
                             generate_lshape(1, with(GetParam(), 1, size)),
                             generate_annulus(0.3, 0.7, with(GetParam(), 1, size))}) {
      double sum = 0;
      for (std::size_t e = 0; e < mesh.edge_count(); ++e)
        sum += norm(mesh.control(mesh.edge_nodes(EdgeId(e))[1]) -
                    mesh.control(mesh.edge_nodes(EdgeId(e))[0]));
      const double mean = sum / static_cast<double>(mesh.edge_count());
      EXPECT_GT(mean, 0.75 * size);
      EXPECT_LT(mean, 1.25 * size);
      // Seen over 8 seeds: 22 degrees and more, 16 in the annulus that is one triangle wide.
      EXPECT_GT(min_angle(mesh), size > 0.2 ? 15 : 20);
    }
  }
}

TEST_P(EveryPattern, ExtremeShapes) {
  // Sizes far above the shape, thin rectangles and annuli, a small hole.
  for (const int g : {1, 2, 4}) {
    for (const auto& mesh : {generate_rectangle(1, 1, with(GetParam(), g, 10)),
                             generate_rectangle(1, 0.01, with(GetParam(), g, 0.25)),
                             generate_disc(1e-9, with(GetParam(), g, 1e5)),
                             generate_disc(1e9, with(GetParam(), g, 7e8)),
                             generate_lshape(1, with(GetParam(), g, 10))}) {
      expect_consistent(mesh);
      if (mesh.box().diameter() > 1e-6)
        expect_all_valid(mesh);  // below, the centre's rounding is coarse
      EXPECT_EQ(euler(mesh), 1);
    }
    for (const auto& mesh : {generate_annulus(0.99, 1, with(GetParam(), g, 0.3)),
                             generate_annulus(0.01, 1, with(GetParam(), g, 0.25)),
                             generate_annulus(0.7, 1, with(GetParam(), g, 0.25)),
                             generate_annulus(0.5, 1, with(GetParam(), g, 100))}) {
      expect_consistent(mesh);
      expect_all_valid(mesh);
      EXPECT_EQ(euler(mesh), 0);
    }
  }
}

TEST(Generate, SeedsGiveDifferentMeshesAndTheSameSeedTheSameBits) {
  const auto a = generate_disc(1, with(Pattern::unstructured, 3, 0.2, 7));
  const auto b = generate_disc(1, with(Pattern::unstructured, 3, 0.2, 7));
  const auto c = generate_disc(1, with(Pattern::unstructured, 3, 0.2, 8));
  const auto control = [](const TriangleMesh& m) {
    return std::vector<Vec2>(m.control().begin(), m.control().end());
  };
  const auto elements = [](const TriangleMesh& m) {
    return std::vector<NodeId>(m.connectivity().begin(), m.connectivity().end());
  };
  EXPECT_EQ(control(a), control(b));
  EXPECT_EQ(elements(a), elements(b));
  EXPECT_EQ(a.tags(), b.tags());
  EXPECT_NE(control(a), control(c));
}

TEST_P(EveryPattern, JitterBendsInnerEdgesOnly) {
  for (const int g : {2, 3, 6}) {
    auto options = with(GetParam(), g, 0.3, 5);
    const auto plain = generate_disc(1, options);
    options.curve_jitter = 0.15;
    const auto mesh = generate_disc(1, options);
    expect_all_valid(mesh);
    ASSERT_EQ(mesh.edge_count(), plain.edge_count());
    std::size_t bent = 0, inner = 0;
    for (std::size_t e = 0; e < mesh.edge_count(); ++e) {
      std::vector<Vec2> a(static_cast<std::size_t>(g) + 1), b(a.size());
      mesh.gather_edge(EdgeId(e), a);
      plain.gather_edge(EdgeId(e), b);
      if (mesh.is_boundary(EdgeId(e))) {
        EXPECT_EQ(a, b);
        continue;
      }
      ++inner;
      double farthest = 0;
      for (int i = 0; i <= 20; ++i)
        farthest = std::max(farthest, norm(bernstein::evaluate<Vec2>(a, i / 20.0) -
                                           bernstein::evaluate<Vec2>(b, i / 20.0)));
      EXPECT_LE(farthest, 0.15 * norm(a.back() - a.front()) * (1 + 1e-12));
      if (farthest > 0.01 * norm(a.back() - a.front())) ++bent;
    }
    EXPECT_GT(bent, inner / 2);
  }
}

TEST(Generate, StrongJitterStaysValid) {
  auto options = with(Pattern::unstructured, 4, 0.3, 3);
  options.curve_jitter = 0.5;
  expect_all_valid(generate_rectangle(1, 1, options));
  expect_all_valid(generate_annulus(0.5, 1, options));
}

TEST(Generate, JitterOfDegreeOneDoesNothing) {
  auto options = with(Pattern::unstructured, 1, 0.3);
  const auto plain = generate_disc(1, options);
  options.curve_jitter = 0.3;
  const auto mesh = generate_disc(1, options);
  EXPECT_TRUE(std::equal(plain.control().begin(), plain.control().end(), mesh.control().begin(),
                         mesh.control().end()));
}

TEST(GenerateBadInput, Messages) {
  const auto good = with(Pattern::unstructured, 2, 0.3);
  const auto changed = [&](auto change) {
    auto options = good;
    change(options);
    return message_of([&] { generate_rectangle(1, 1, options); });
  };
  EXPECT_EQ(message_of([&] { generate_rectangle(-1, 1, good); }),
            "found width -1, expected a length from 1e-100 to 1e100");
  EXPECT_EQ(message_of([&] { generate_rectangle(1, 0, good); }),
            "found height 0, expected a length from 1e-100 to 1e100");
  EXPECT_EQ(message_of([&] { generate_disc(std::nan(""), good); }),
            "found radius nan, expected a length from 1e-100 to 1e100");
  EXPECT_EQ(message_of([&] { generate_lshape(std::numeric_limits<double>::infinity(), good); }),
            "found width inf, expected a length from 1e-100 to 1e100");
  EXPECT_EQ(message_of([&] { generate_annulus(0, 1, good); }),
            "found inner radius 0, expected a length from 1e-100 to 1e100");
  EXPECT_EQ(message_of([&] { generate_annulus(1, 1, good); }),
            "found inner radius 1 and outer radius 1, expected inner < outer");
  EXPECT_EQ(changed([](auto& o) { o.size = 0; }),
            "found size 0, expected a length from 1e-100 to 1e100");
  EXPECT_EQ(changed([](auto& o) { o.degree = 0; }), "found geometric degree 0, expected 1 to 10");
  EXPECT_EQ(changed([](auto& o) { o.degree = 11; }), "found geometric degree 11, expected 1 to 10");
  EXPECT_EQ(changed([](auto& o) { o.curve_jitter = 0.6; }),
            "found curve jitter 0.6, expected 0 to 0.5");
  EXPECT_EQ(changed([](auto& o) { o.curve_jitter = std::nan(""); }),
            "found curve jitter nan, expected 0 to 0.5");
  EXPECT_EQ(changed([](auto& o) { o.centre[1] = std::nan(""); }),
            "found centre (0.3, nan), expected finite coordinates");
  EXPECT_EQ(
      changed([](auto& o) { o.centre[0] = -1e13; }),
      "found a length of 0.3 at a distance of 1e+13 from the origin, expected at least 1e-12 of "
      "the distance");
  EXPECT_EQ(
      message_of([&] { generate_annulus(0.5, 0.5 + 0x1p-40, good); }),
      "found a gap of 9.09495e-13 between the circles, expected at least 1e-9 of the outer radius");
  EXPECT_EQ(changed([](auto& o) { o.size = 1e-5; }),
            "size 1e-05 would give about 2.30944e+10 elements, expected at most 5e7");
  EXPECT_EQ(changed([](auto& o) { o.size = 2.2e-4, o.degree = 10; }).substr(0, 46),
            "size 0.00022 and degree 10 would give about 2.");
}

}  // namespace
}  // namespace bezel
