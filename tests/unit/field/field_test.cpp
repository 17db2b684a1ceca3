#include "bezel/field/field.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "bezel/base/error.hpp"
#include "checks.hpp"
#include "meshes.hpp"

namespace bezel {
namespace {

using bernstein::triangle_size;
using field_test::MeshPtr;
using field_test::message_of;

const std::vector<Lambda> places{
    {1, 0, 0},       {0, 1, 0},       {0, 0, 1},          {0.5, 0.5, 0},
    {0.2, 0.3, 0.5}, {0.7, 0.1, 0.2}, {0.01, 0.02, 0.97}, {1.0 / 3, 1.0 / 3, 1.0 / 3}};

Vec2 place_of(const TriangleMesh& mesh, ElementId e, const Lambda& lambda) {
  return bernstein::evaluate<Vec2>(mesh.degree(), mesh.gather(e), lambda);
}

TEST(Field, PartitionOfUnity) {
  // All coefficients 1: the value is 1 and the gradient 0, in both bases, at every degree.
  for (const MeshPtr& mesh : {field_test::two_quadratic(), field_test::wavy(2, 3)})
    for (const Basis basis : {Basis::reference, Basis::physical})
      for (int d = 0; d <= Space::max_degree; ++d) {
        const auto space = Space::discontinuous(mesh, d, basis);
        const Field one("one", space, std::vector<double>(space->coefficient_count(), 1.0));
        for (std::size_t e = 0; e < mesh->element_count(); ++e)
          for (const Lambda& lambda : places) {
            double value = 0.0;
            one.evaluate(ElementId(e), lambda, {&value, 1});
            EXPECT_NEAR(value, 1.0, 4e-16 * (d + 2)) << d;
            std::array<double, 2> slope{};
            one.gradient(ElementId(e), lambda, slope);
            EXPECT_NEAR(slope[0], 0.0, 1e-13) << d;
            EXPECT_NEAR(slope[1], 0.0, 1e-13) << d;
          }
      }
}

TEST(Field, LinearPrecision) {
  // Reference basis of the mesh's own degree with the control points as coefficients is the map
  // itself.
  const MeshPtr mesh = field_test::wavy(2, 4);
  const auto space = Space::discontinuous(mesh, 4);
  std::vector<double> c;
  for (std::size_t e = 0; e < mesh->element_count(); ++e)
    for (const Vec2& p : mesh->gather(ElementId(e))) c.insert(c.end(), {p.x(), p.y()});
  const Field field("position", space, c, 2);
  for (std::size_t e = 0; e < mesh->element_count(); ++e)
    for (const Lambda& lambda : places) {
      std::array<double, 2> value{};
      std::array<double, 4> slope{};
      field.evaluate(ElementId(e), lambda, value);
      field.gradient(ElementId(e), lambda, slope);
      const Vec2 p = place_of(*mesh, ElementId(e), lambda);
      EXPECT_NEAR(value[0], p.x(), 1e-15);
      EXPECT_NEAR(value[1], p.y(), 1e-15);
      EXPECT_NEAR(slope[0], 1.0, 2e-14);
      EXPECT_NEAR(slope[1], 0.0, 2e-14);
      EXPECT_NEAR(slope[2], 0.0, 2e-14);
      EXPECT_NEAR(slope[3], 1.0, 2e-14);
    }
}

TEST(Field, PhysicalBasisIsTheFramePolynomial) {
  // Degree 1 on a frame: the value is the linear interpolant of the frame's corners, wherever the
  // point lies.
  const MeshPtr mesh = field_test::two_quadratic();
  const auto space = Space::discontinuous(mesh, 1, Basis::physical);
  std::vector<double> c;
  for (const Frame& frame : space->frames())
    for (const Vec2& corner : frame.corners())
      c.push_back(2.5 - 3.0 * corner.x() + 0.7 * corner.y());
  const Field field("plane", space, c);
  for (std::size_t e = 0; e < 2; ++e)
    for (const Lambda& lambda : places) {
      double value = 0.0;
      std::array<double, 2> slope{};
      field.evaluate(ElementId(e), lambda, {&value, 1});
      field.gradient(ElementId(e), lambda, slope);
      const Vec2 p = place_of(*mesh, ElementId(e), lambda);
      EXPECT_NEAR(value, 2.5 - 3.0 * p.x() + 0.7 * p.y(), 4e-15);
      EXPECT_NEAR(slope[0], -3.0, 2e-14);
      EXPECT_NEAR(slope[1], 0.7, 2e-14);
    }
}

TEST(Field, GradientAgainstCentralDifferences) {
  const MeshPtr mesh = field_test::wavy(2, 3);
  const Lambda middle{0.3, 0.45, 0.25};
  for (const Basis basis : {Basis::reference, Basis::physical})
    for (int d = 1; d <= Space::max_degree; ++d) {
      const auto space = Space::discontinuous(mesh, d, basis);
      std::vector<double> c(space->coefficient_count());
      for (std::size_t i = 0; i < c.size(); ++i) c[i] = std::sin(1.7 * static_cast<double>(i));
      const Field field("f", space, c);
      const ElementId e(3);
      std::array<double, 2> slope{};
      field.gradient(e, middle, slope);
      // Along u and v the value's derivative is slope . d(map).
      const auto map = bernstein::evaluate_gradient<Vec2>(3, mesh->gather(e), middle);
      const double h = 1e-5;
      for (int way = 0; way < 2; ++way) {
        const auto moved = [&](double by) {
          Lambda l = middle;
          l[0] -= by;
          l[static_cast<std::size_t>(way + 1)] += by;
          double value = 0.0;
          field.evaluate(e, l, {&value, 1});
          return value;
        };
        const double difference = (moved(h) - moved(-h)) / (2 * h);
        const Vec2 direction = way == 0 ? map.du : map.dv;
        // Truncation h^2/6 times a third derivative (at most 8 d^3) and rounding u/h.
        EXPECT_NEAR(dot(Vec2{slope[0], slope[1]}, direction), difference, 2e-10 * d * d * d + 1e-10)
            << d;
      }
    }
}

TEST(Field, ComponentsAreInterleaved) {
  const MeshPtr mesh = field_test::two_quadratic();
  const auto space = Space::discontinuous(mesh, std::vector<int>{2, 1});
  std::vector<double> c(space->coefficient_count() * 3);
  for (std::size_t i = 0; i < c.size(); ++i) c[i] = 0.1 * static_cast<double>(i * i);
  const Field field("v", space, c, 3);
  EXPECT_EQ(field.components(), 3);
  EXPECT_EQ(field.name(), "v");
  EXPECT_EQ(field.coefficients().size(), 27u);
  const auto second = field.coefficients(ElementId(1));
  ASSERT_EQ(second.size(), 9u);
  EXPECT_EQ(second[0], c[18]);
  std::array<double, 3> value{};
  field.evaluate(ElementId(1), {0, 1, 0}, value);  // corner 1 of degree 1: the second coefficient
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(value[k], c[18 + 3 + k]);
  const Field other = field.renamed("w");
  EXPECT_EQ(other.name(), "w");
  EXPECT_EQ(other.space_ptr(), field.space_ptr());
}

TEST(Field, BatchAgreesWithSinglePoints) {
  const MeshPtr mesh = field_test::wavy(2, 2);
  std::vector<Lambda> many;
  for (int i = 0; i < 150; ++i) {
    const double s = 0.1 + 0.8 * i / 149.0, t = std::fmod(0.37 * i, 1.0);
    many.push_back({1 - s, s * (1 - t), s * t});
  }
  for (const Basis basis : {Basis::reference, Basis::physical})
    for (int d = 0; d <= Space::max_degree; ++d) {
      const auto space = Space::discontinuous(mesh, d, basis);
      std::vector<double> c(space->coefficient_count() * 2);
      for (std::size_t i = 0; i < c.size(); ++i) c[i] = std::cos(2.3 * static_cast<double>(i));
      const Field field("f", space, c, 2);
      std::vector<double> all(300);
      field.evaluate(ElementId(5), many, all);
      for (std::size_t q = 0; q < many.size(); ++q) {
        std::array<double, 2> one{};
        field.evaluate(ElementId(5), many[q], one);
        EXPECT_NEAR(all[2 * q], one[0], 1e-14) << d;
        EXPECT_NEAR(all[2 * q + 1], one[1], 1e-14) << d;
      }
      field.evaluate(ElementId(5), std::span<const Lambda>{}, {});
    }
}

TEST(Field, Errors) {
  const auto space = Space::discontinuous(field_test::straight(1), std::vector<int>{1, 2});
  const auto make = [&](std::string name, std::size_t size, int components) {
    return message_of([&] { Field(name, space, std::vector<double>(size), components); });
  };
  EXPECT_EQ(make("", 9, 1), "a field needs a name, found an empty one");
  EXPECT_EQ(make("T", 10, 1),
            "field 'T' has 10 values, expected 9 (coefficients 9 x components 1)");
  EXPECT_EQ(make("T", 9, 2), "field 'T' has 9 values, expected 18 (coefficients 9 x components 2)");
  EXPECT_EQ(make("T", 9, 0), "field 'T' has 0 components, expected 1..9");
  EXPECT_EQ(make("T", 90, 10), "field 'T' has 10 components, expected 1..9");
  EXPECT_EQ(message_of([] { Field("T", nullptr, {}); }),
            "field 'T' needs a space, found a null pointer");
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()})
    for (const std::size_t where : {0u, 5u, 6u, 17u}) {
      std::vector<double> c(18, 1.0);
      c[where] = bad;
      EXPECT_EQ(message_of([&] { Field("T", space, c, 2); }),
                "triangle " + std::to_string(where / 6 > 0 ? 1 : 0) +
                    ": field 'T' has a value that is not finite");
    }
  const Field field("T", space, std::vector<double>(9, 1.0));
  std::array<double, 2> two{};
  EXPECT_EQ(message_of([&] {
              field.evaluate(ElementId(2), {1, 0, 0}, {two.data(), 1});
            }),
            "triangle 2 does not exist, the mesh has 2");
  EXPECT_EQ(message_of([&] {
              field.gradient(ElementId{}, {1, 0, 0}, two);
            }),
            "triangle -1 does not exist, the mesh has 2");
  EXPECT_EQ(message_of([&] {
              field.evaluate(ElementId(0), {1, 0, 0}, two);
            }),
            "found room for 2 values, expected 1");
  EXPECT_EQ(message_of([&] {
              field.gradient(ElementId(0), {1, 0, 0}, {two.data(), 1});
            }),
            "found room for 1 values, expected 2");
  EXPECT_EQ(message_of([&] { field.evaluate(ElementId(0), std::span<const Lambda>(places), two); }),
            "found room for 2 values, expected 8");
}

}  // namespace
}  // namespace bezel
