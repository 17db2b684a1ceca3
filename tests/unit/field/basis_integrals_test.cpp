#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bezel/bernstein/triangle.hpp"
#include "bezel/field/integrals.hpp"
#include "bezel/geometry/triangle.hpp"
#include "meshes.hpp"

namespace bezel {
namespace {

/// By quadrature over the element, far above the degree needed.
std::vector<double> by_quadrature(const Space& space, ElementId e) {
  const TriangleMesh& mesh = *space.mesh();
  const int g = mesh.degree(), d = space.degree(e);
  const std::vector<Vec2> control = mesh.gather(e);
  const TriangleRule rule = triangle_rule(std::min(d * g + 2 * g, 80));
  std::vector<double> out(static_cast<std::size_t>(bernstein::triangle_size(d)), 0.0);
  std::vector<double> basis(out.size());
  for (std::size_t q = 0; q < rule.weight.size(); ++q) {
    const auto at = bernstein::evaluate_gradient<Vec2>(g, control, rule.lambda[q]);
    const Lambda own =
        space.basis() == Basis::physical ? space.frame(e).lambda(at.value) : rule.lambda[q];
    bernstein::basis(d, own, basis);
    for (std::size_t n = 0; n < out.size(); ++n)
      out[n] += rule.weight[q] * cross(at.du, at.dv) * basis[n];
  }
  return out;
}

void expect_agreement(const Space& space) {
  const std::vector<double> found = field_detail::basis_integrals(space, 1);
  EXPECT_EQ(found, field_detail::basis_integrals(space, 2));
  for (std::size_t e = 0; e < space.mesh()->element_count(); ++e) {
    const ElementId id(e);
    const std::vector<double> expected = by_quadrature(space, id);
    const double scale = *std::max_element(expected.begin(), expected.end());
    for (std::size_t n = 0; n < expected.size(); ++n) {
      EXPECT_NEAR(found[space.offset(id) + n], expected[n], 1e-14 * scale)
          << "degree " << space.degree(id) << " element " << e << " function " << n;
    }
  }
}

// 18 elements: whole blocks and a part of one.
TEST(BasisIntegrals, AgreeWithQuadratureOnCurvedElements) {
  for (const int g : {2, 3, 5}) {
    const auto mesh = field_test::wavy(3, g);
    for (const Basis basis : {Basis::reference, Basis::physical})
      for (const int d : {0, 1, 2, 3, 6, Space::max_degree})
        expect_agreement(*Space::discontinuous(mesh, d, basis));
  }
}

TEST(BasisIntegrals, AgreeWithQuadratureForMixedDegrees) {
  const auto mesh = field_test::wavy(3, 3);
  std::vector<int> degrees;
  for (std::size_t e = 0; e < mesh->element_count(); ++e)
    degrees.push_back(static_cast<int>(e * e % 4));
  for (const Basis basis : {Basis::reference, Basis::physical})
    expect_agreement(*Space::discontinuous(mesh, degrees, basis));
}

// Straight elements in frames that are their own, and in frames of the caller's.
TEST(BasisIntegrals, AgreeWithQuadratureOnStraightElements) {
  const auto mesh = field_test::straight(3);
  const auto own = Space::discontinuous(mesh, 3, Basis::physical);
  EXPECT_TRUE(own->has_own_frames());
  expect_agreement(*own);
  std::vector<Frame> frames(own->frames().begin(), own->frames().end());
  for (std::size_t e = 0; e < frames.size(); e += 3) {
    frames[e].centre += Vec2{0.02, -0.01};
    for (Vec2& gradient : frames[e].gradient) gradient *= 0.75;
  }
  const auto mixed = Space::discontinuous(mesh, std::vector<int>(frames.size(), 3), frames);
  EXPECT_FALSE(mixed->has_own_frames());
  EXPECT_FALSE(mixed->is_own_frame(ElementId(0)));
  EXPECT_TRUE(mixed->is_own_frame(ElementId(1)));
  expect_agreement(*mixed);
}

}  // namespace
}  // namespace bezel
