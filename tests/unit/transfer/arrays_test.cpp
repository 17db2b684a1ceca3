#include "bezel/transfer/arrays.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "support/meshes.hpp"
#include "support/message_of.hpp"

namespace bezel {
namespace {

using test::bend;
using test::grid_mesh;
using test::message_of;

/// A mesh's arrays, owned.
struct Arrays {
  explicit Arrays(const TriangleMesh& mesh) {
    for (const Vec2& p : mesh.control()) coordinates.insert(coordinates.end(), {p[0], p[1]});
    for (const NodeId n : mesh.connectivity()) connectivity.push_back(n.value);
    degree = mesh.degree();
  }
  MeshArrays view() const { return {degree, coordinates, connectivity, Values::bernstein}; }
  int degree;
  std::vector<double> coordinates;
  std::vector<std::int32_t> connectivity;
};

TEST(TransferArrays, GivesTheBitsOfTheObjects) {
  const auto donor = grid_mesh(4, 2, 1.0, bend(0.15, 0.12));
  const auto target = grid_mesh(5, 3, 1.0, bend(-0.1, 0.1));
  const std::vector<Formula> wave = {Formula("sin(2*x)+y"), Formula("x*y")};
  const Field f = project("u", Space::discontinuous(donor, 2, Basis::physical), wave);
  const TransferResult objects = transfer(std::span(&f, 1), target);
  const Arrays a(*donor);
  const Arrays b(*target);
  const FieldArrays field{2, 2, Basis::physical, f.coefficients(), Values::bernstein};
  const ArraysResult arrays = transfer(a.view(), std::span(&field, 1), b.view());
  ASSERT_EQ(arrays.coefficients.size(), 1U);
  EXPECT_TRUE(std::equal(arrays.coefficients[0].begin(), arrays.coefficients[0].end(),
                         objects.fields[0].coefficients().begin()));
  EXPECT_EQ(arrays.report.pairs, objects.report.pairs);
}

TEST(TransferArrays, NodalMeshesAndValuesComeBackNodal) {
  // x y at the nodes of a straight mesh: the values at the target's nodes must be x y again.
  const auto mesh = grid_mesh(3, 1, 1.0, test::same_place);
  const auto fine = grid_mesh(4, 1, 0.9, test::same_place);
  const Arrays a(*mesh);
  const Arrays b(*fine);
  const auto values = [](const TriangleMesh& m) {
    std::vector<double> out;
    for (std::size_t e = 0; e < m.element_count(); ++e) {
      const auto c = m.gather(ElementId(e));
      for (int k = 0; k <= 2; ++k) {
        for (int j = 0; j <= 2 - k; ++j) {
          const Vec2 p = (c[0] * (2.0 - j - k) + c[1] * static_cast<double>(j) +
                          c[2] * static_cast<double>(k)) *
                         0.5;
          out.push_back(p[0] * p[1]);
        }
      }
    }
    return out;
  };
  const auto donor_values = values(*mesh);
  const FieldArrays field{2, 1, Basis::reference, donor_values, Values::nodal};
  const ArraysResult result = transfer(a.view(), std::span(&field, 1), b.view());
  const auto expected = values(*fine);
  ASSERT_EQ(result.coefficients[0].size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(result.coefficients[0][i], expected[i], 1e-13);
}

TEST(TransferArrays, NodalGeometryEqualsItsControlPoints) {
  const auto mesh = grid_mesh(3, 3, 1.0, bend(0.15, 0.12));
  const auto target = grid_mesh(3, 2, 0.6, test::same_place);
  Arrays nodal(*mesh);
  for (std::size_t e = 0; e < mesh->element_count(); ++e) {
    const auto points = bernstein::to_lagrange<Vec2>(3, mesh->gather(ElementId(e)));
    const auto nodes = mesh->nodes(ElementId(e));
    for (std::size_t i = 0; i < points.size(); ++i) {
      nodal.coordinates[2 * nodes[i].index()] = points[i][0];
      nodal.coordinates[2 * nodes[i].index() + 1] = points[i][1];
    }
  }
  const Formula wave("1+x+y^2");
  const Field f = project("u", Space::discontinuous(mesh, 2), {&wave, 1});
  const Arrays b(*target);
  const FieldArrays field{2, 1, Basis::reference, f.coefficients(), Values::bernstein};
  MeshArrays view = nodal.view();
  view.values = Values::nodal;
  const ArraysResult result = transfer(view, std::span(&field, 1), b.view());
  const TransferResult objects = transfer(std::span(&f, 1), target);
  for (std::size_t i = 0; i < result.coefficients[0].size(); ++i) {
    EXPECT_NEAR(result.coefficients[0][i], objects.fields[0].coefficients()[i], 1e-12);
  }
}

TEST(TransferArrays, WrongSizesAreNamed) {
  const auto mesh = grid_mesh(2, 1, 1.0, test::same_place);
  const Arrays a(*mesh);
  const std::vector<double> values(mesh->element_count() * 3, 1.0);
  FieldArrays field{1, 1, Basis::reference, values, Values::bernstein};
  MeshArrays broken = a.view();
  broken.degree = 11;
  EXPECT_EQ(message_of([&] { (void)transfer(broken, std::span(&field, 1), a.view()); }),
            "donor mesh: degree 11 is not supported, expected 1 to 10");
  broken = a.view();
  broken.coordinates = broken.coordinates.subspan(1);
  EXPECT_EQ(message_of([&] { (void)transfer(a.view(), std::span(&field, 1), broken); }),
            "target mesh: found 17 coordinates, expected two per node");
  broken = a.view();
  broken.connectivity = broken.connectivity.subspan(1);
  EXPECT_EQ(message_of([&] { (void)transfer(broken, std::span(&field, 1), a.view()); }),
            "donor mesh: found 23 node numbers, expected 3 per triangle");
  field.degree = 2;
  EXPECT_EQ(message_of([&] { (void)transfer(a.view(), std::span(&field, 1), a.view()); }),
            "field 0: found 24 values, expected 48");
  field.values = Values::nodal;
  field.basis = Basis::physical;
  EXPECT_EQ(message_of([&] { (void)transfer(a.view(), std::span(&field, 1), a.view()); }),
            "field 0: nodal values of a physical basis are not supported, expected Bernstein "
            "coefficients");
}

}  // namespace
}  // namespace bezel
