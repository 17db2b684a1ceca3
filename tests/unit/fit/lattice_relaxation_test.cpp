#include "bezel/fit/lattice_relaxation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "bezel/geometry/triangle.hpp"
#include "support/meshes.hpp"

namespace bezel {
namespace {

using test::grid_mesh;

/// A straight grid of degree 3, its boundary fixed.
struct Body {
  std::shared_ptr<const TriangleMesh> mesh = grid_mesh(3, 3, 1.0, [](const Vec2& p) { return p; });
  std::vector<Vec2> start{mesh->control().begin(), mesh->control().end()};
  std::vector<char> fixed = std::vector<char>(start.size(), 0);

  Body() {
    for (std::size_t e = 0; e < mesh->edge_count(); ++e)
      if (mesh->is_boundary(EdgeId(e)))
        for (const NodeId n : mesh->edge_nodes(EdgeId(e))) fixed[n.index()] = 1;
  }
  std::vector<Vec2> relax(const std::vector<Vec2>& target, int steps) const {
    return fit::relax_lattice(3, mesh->connectivity(), start, fixed, target, steps);
  }
};

// The lattice is uniform, so an affine displacement is in equilibrium whatever the stiffness.
TEST(LatticeRelaxation, AffineMapsOfTheBoundaryReachTheInside) {
  const Body body;
  std::vector<Vec2> target;
  for (const Vec2& p : body.start)
    target.push_back(Vec2{{0.3 + 1.2 * p.x() + 0.4 * p.y(), -0.1 * p.x() + 0.8 * p.y()}});
  const std::vector<Vec2> found = body.relax(target, 1);
  ASSERT_EQ(found.size(), target.size());
  for (std::size_t n = 0; n < found.size(); ++n) {
    EXPECT_LT(norm(found[n] - target[n]), 1e-8) << n;
    if (body.fixed[n] != 0) {
      EXPECT_EQ(found[n], target[n]) << n;
    }
  }
}

TEST(LatticeRelaxation, WithoutAMoveNothingChanges) {
  const Body body;
  EXPECT_EQ(body.relax(body.start, 4), body.start);
}

// A side pushed in by more than a row of lattice points: with its inner points left where they were
// elements fold, as an elastic body they do not.
TEST(LatticeRelaxation, UnfoldsElementsUnderALargeMove) {
  const Body body;
  std::vector<Vec2> target = body.start;
  double least = INFINITY, most = -INFINITY;
  for (const Vec2& p : body.start) least = std::min(least, p.y()), most = std::max(most, p.y());
  for (std::size_t n = 0; n < target.size(); ++n)
    if (body.fixed[n] != 0 && target[n].y() == least)
      target[n] +=
          Vec2{{0.0, 0.35 * (most - least) * std::cos(1.5707963267948966 * target[n].x())}};
  const auto folded = [&](const std::vector<Vec2>& control) {
    const TriangleMesh moved(3, control,
                             {body.mesh->connectivity().begin(), body.mesh->connectivity().end()});
    int count = 0;
    for (std::size_t e = 0; e < moved.element_count(); ++e)
      if (check_validity(3, moved.gather(ElementId(e))).status != Validity::valid) ++count;
    return count;
  };
  EXPECT_GT(folded(target), 0);
  EXPECT_EQ(folded(body.relax(target, 8)), 0);
}

}  // namespace
}  // namespace bezel
