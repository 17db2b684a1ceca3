#include "bezel/transfer/share.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "bezel/base/error.hpp"
#include "bezel/base/random.hpp"
#include "bezel/transfer/operator_by.hpp"
#include "support/fields.hpp"
#include "support/in_shares.hpp"
#include "support/mesh_pairs.hpp"

namespace bezel::detail {
namespace {

using test::in_shares;
using test::MeshPtr;

void expect_same_report(const FieldReport& a, const FieldReport& b) {
  EXPECT_EQ(a.mass_after, b.mass_after);
  EXPECT_EQ(a.mass_outside, b.mass_outside);
  EXPECT_EQ(a.mass_made, b.mass_made);
  EXPECT_EQ(a.mass_spread, b.mass_spread);
  EXPECT_EQ(a.min_after, b.min_after);
  EXPECT_EQ(a.max_after, b.max_after);
  EXPECT_EQ(a.max_element_defect, b.max_element_defect);
}

void expect_same_geometry(const TransferReport& a, const TransferReport& b) {
  EXPECT_EQ(a.pairs, b.pairs);
  EXPECT_EQ(a.crossings, b.crossings);
  EXPECT_EQ(a.tangencies, b.tangencies);
  EXPECT_EQ(a.overlaps, b.overlaps);
  EXPECT_EQ(a.unresolved, b.unresolved);
  EXPECT_EQ(a.uncovered_area, b.uncovered_area);
  EXPECT_EQ(a.uncovered_elements, b.uncovered_elements);
  EXPECT_EQ(a.extension_growth, b.extension_growth);
  EXPECT_EQ(a.extension_moved_area, b.extension_moved_area);
  EXPECT_EQ(a.extension_held_area, b.extension_held_area);
  EXPECT_EQ(a.outside_area, b.outside_area);
  EXPECT_EQ(a.max_partition_residual, b.max_partition_residual);
  EXPECT_EQ(a.max_joint_gap, b.max_joint_gap);
}

void expect_same(const TransferResult& a, const TransferResult& b) {
  ASSERT_EQ(a.fields.size(), b.fields.size());
  for (std::size_t i = 0; i < a.fields.size(); ++i)
    EXPECT_TRUE(std::ranges::equal(a.fields[i].coefficients(), b.fields[i].coefficients())) << i;
  ASSERT_EQ(a.report.fields.size(), b.report.fields.size());
  for (std::size_t i = 0; i < a.report.fields.size(); ++i)
    expect_same_report(a.report.fields[i], b.report.fields[i]);
  expect_same_geometry(a.report, b.report);
}

/// All shares together give the bits of the whole.
void check(std::span<const Field> donors, const MeshPtr& target, const TransferOptions& options,
           std::size_t count = 3) {
  const TransferResult whole = transfer(donors, target, options);
  expect_same(transfer_by({in_shares(count)}, donors, target, options, {}), whole);
}

MeshPtr turned(const MeshPtr& mesh, double angle, double scale, const Vec2& to) {
  const double c = scale * std::cos(angle);
  const double s = scale * std::sin(angle);
  return test::with_control(mesh, [&](const Vec2& p, std::size_t) {
    return Vec2{{c * p[0] - s * p[1] + to[0], s * p[0] + c * p[1] + to[1]}};
  });
}

/// The elements of a mesh that `keep` wants.
template <class Keep>
MeshPtr part_of(const MeshPtr& mesh, const Keep& keep) {
  std::vector<NodeId> nodes;
  for (std::size_t e = 0; e < mesh->element_count(); ++e) {
    if (!keep(mesh->box(ElementId(e)).centre())) continue;
    const auto own = mesh->nodes(ElementId(e));
    nodes.insert(nodes.end(), own.begin(), own.end());
  }
  const auto control = mesh->control();
  return std::make_shared<const TriangleMesh>(
      mesh->degree(), std::vector<Vec2>(control.begin(), control.end()), std::move(nodes));
}

Field wave(const std::shared_ptr<const Space>& space) {
  const std::vector<Formula> formulas = {Formula("sin(3*x)+y*y"), Formula("x*y-2")};
  return sample("wave", space, formulas);
}

const MeshPtr& bent_grid(int g) {
  static const std::array<MeshPtr, 3> grids = {test::grid_mesh(20, 1, 1.0, test::bend(0.1, 0.2)),
                                               test::grid_mesh(20, 2, 1.0, test::bend(0.1, 0.2)),
                                               test::grid_mesh(20, 3, 1.0, test::bend(0.1, 0.2))};
  return grids.at(static_cast<std::size_t>(g - 1));
}

// Each process finds the planes in which thin elements are round by itself.
TEST(Share, ThinElementsGiveTheBitsOfTheWhole) {
  for (const int g : {1, 2}) {
    const auto flat = [&](const MeshPtr& mesh) {
      return test::with_control(mesh, [](const Vec2& p, std::size_t) {
        return Vec2{{p[0] - 1e-5 * p[1], 0.3 * p[0] + 1e-5 * p[1]}};
      });
    };
    const MeshPtr donor = flat(bent_grid(g));
    const MeshPtr target = flat(test::grid_mesh(g == 1 ? 24 : 16, g, 0.9, test::bend(-0.1, 0.1)));
    for (const Basis basis : {Basis::reference, Basis::physical}) {
      TransferOptions options;
      options.threads = 1;
      check(std::vector<Field>{wave(Space::discontinuous(donor, 1, basis))}, target, options, 2);
    }
  }
}

TEST(Share, SplitTakesEveryElementOnceAndAboutTheSameWork) {
  const OverlayMesh donor(bent_grid(1), "donor", 1);
  const OverlayMesh target(turned(test::grid_mesh(40, 1, 1.0, test::same_place), 0.4, 0.7, {}),
                           "target", 1);
  const FrontSearch search(donor);
  const std::vector<Share> shares = split_work(donor, target, search, 4, 1);
  ASSERT_EQ(shares.size(), 4U);
  std::vector<std::int32_t> all;
  for (const Share& share : shares) {
    all.insert(all.end(), share.own.begin(), share.own.end());
    EXPECT_NEAR(static_cast<double>(share.own.size()), 800.0, 256.0);
    EXPECT_TRUE(std::ranges::is_sorted(share.targets));
    EXPECT_TRUE(std::ranges::is_sorted(share.donors));
    // A quarter of the target needs far less than the whole donor.
    EXPECT_LT(share.donors.size(), donor.element_count() / 2);
  }
  EXPECT_EQ(all, target.spatial_order());
}

TEST(Share, MoreSharesThanChunksLeaveSomeEmpty) {
  const OverlayMesh mesh(test::grid_mesh(4, 1, 1.0, test::same_place), "donor", 1);
  const FrontSearch search(mesh);
  std::size_t own = 0;
  for (const Share& share : split_work(mesh, mesh, search, 5, 1)) own += share.own.size();
  EXPECT_EQ(own, mesh.element_count());
}

TEST(Share, SameBitsInEveryBasis) {
  const MeshPtr target = turned(test::grid_mesh(22, 2, 1.0, test::bend(0.1, 0.1)), 0.3, 0.6, {});
  for (const Basis basis : {Basis::reference, Basis::physical}) {
    for (const int g : {1, 2}) {
      const Field f = wave(Space::discontinuous(bent_grid(g), 2, basis));
      TransferOptions options;
      options.degree = 1;
      check({&f, 1}, target, options);
    }
  }
}

TEST(Share, SameBitsOnStraightMeshesForSeveralSpaces) {
  const MeshPtr donor = bent_grid(1);
  std::vector<int> degrees(donor->element_count());
  for (std::size_t e = 0; e < degrees.size(); ++e) degrees[e] = e < 500 ? 1 : 3;
  const std::vector<Field> fields = {
      wave(Space::discontinuous(donor, 1)), wave(Space::discontinuous(donor, degrees)),
      wave(Space::continuous(donor, 2)), test::checkerboard(donor, 0, Basis::reference)};
  check(fields, turned(bent_grid(1), 0.5, 0.6, {}), {}, 2);
  check(fields, turned(bent_grid(1), 0.4, 0.6, {}), {}, 7);
}

TEST(Share, SameBitsWhereMeshesShareEdges) {
  const Field f = wave(Space::discontinuous(bent_grid(2), 1));
  check({&f, 1}, bent_grid(2), {});
  const Field g = wave(Space::discontinuous(bent_grid(1), 1));
  check({&g, 1}, std::make_shared<const TriangleMesh>(refine_uniform(*bent_grid(1))), {});
  // Lattices with edges along each other, and vertices on edges.
  const MeshPtr lattice = test::grid_mesh(15, 1, 1.0, test::same_place);
  const Field h = wave(Space::discontinuous(lattice, 2));
  check({&h, 1}, test::grid_mesh(20, 1, 1.0, test::same_place), {});
}

TEST(Share, SameBitsWhereFieldsAreContinuedFarAway) {
  // The donor: two pieces, one of them with a hole; the target: all around them.
  const MeshPtr donor = part_of(bent_grid(2), [](const Vec2& p) {
    return std::abs(p[0] - 0.4) > 0.2 && !(norm(p + Vec2{{0.4, 0.0}}) < 0.3);
  });
  const Field f = wave(Space::discontinuous(donor, 1));
  const MeshPtr square = test::grid_mesh(20, 1, 1.0, test::same_place);
  TransferOptions options;
  options.degree = 1;
  options.uncovered = Uncovered::extend;
  check({&f, 1}, turned(square, 0.2, 3.0, {}), options);
  options.uncovered = Uncovered::zero;
  check({&f, 1}, turned(square, 0.2, 3.0, {}), options);
  options.uncovered = Uncovered::extend;
  options.conserve = Conserve::total;
  check({&f, 1}, turned(square, 0.2, 1.1, {}), options);
}

// The donors behind a rim of slivers serve beyond it.
TEST(Share, SameBitsWhereBetterDonorsThanTheNearestServe) {
  const auto rim = [](double x) {
    return std::abs(x) < 0.89 ? x / 0.9 * (1.0 - 1e-6)
                              : std::copysign(1.0 - (1.0 - std::abs(x)) * 1e-5, x);
  };
  const MeshPtr donor = test::grid_mesh(20, 1, 1.0, [&](const Vec2& p) {
    return Vec2{{rim(p[0]), rim(p[1])}};
  });
  const Field f = wave(Space::discontinuous(donor, 3));
  TransferOptions options;
  options.degree = 1;
  options.uncovered = Uncovered::extend;
  const MeshPtr target = turned(test::grid_mesh(20, 1, 1.0, test::same_place), 0.1, 1.2, {});
  check({&f, 1}, target, options);
  EXPECT_GT(transfer({&f, 1}, target, options).report.extension_moved_area, 0.1);
}

// What the whole donor is (of one degree, in one piece) decides; the parts are of one degree and in
// one piece.
TEST(Share, SameBitsForADonorOfPiecesAndDegrees) {
  for (const int g : {1, 2}) {
    const MeshPtr donor = part_of(test::grid_mesh(34, g, 1.0, test::bend(0.1, 0.1)),
                                  [](const Vec2& p) { return std::abs(p[1]) > 0.1; });
    std::vector<int> degrees;
    for (std::size_t e = 0; e < donor->element_count(); ++e)
      degrees.push_back(donor->box(ElementId(e)).centre()[1] < 0.5 ? 1 : 2);
    const Field f = wave(Space::discontinuous(donor, degrees));
    TransferOptions options;
    options.degree = 1;
    options.uncovered = Uncovered::extend;
    check({&f, 1}, turned(test::grid_mesh(17, 1, 1.0, test::same_place), 0.05, 1.02, {}), options);
  }
}

TEST(Share, SameBitsForBoundsContinuousTargetsAndWeights) {
  const Field f = test::checkerboard(bent_grid(1), 0, Basis::reference);
  const MeshPtr target = turned(bent_grid(1), 0.3, 0.6, {});
  TransferOptions bounds;
  bounds.degree = 1;
  bounds.bounds = Bounds::local();
  check({&f, 1}, target, bounds);
  TransferOptions continuous;
  continuous.degree = 1;
  continuous.continuity = Continuity::continuous;
  check({&f, 1}, target, continuous);
  TransferOptions weighted;
  weighted.weight = Formula("x+3");
  check({&f, 1}, target, weighted);
}

TEST(Share, SameBitsForSizeRatiosAndFarFromTheOrigin) {
  const Field f = wave(Space::discontinuous(bent_grid(2), 1));
  check({&f, 1}, turned(bent_grid(1), 0.7, 0.01, Vec2{{0.3, -0.2}}), {});
  const Field g = wave(Space::discontinuous(turned(bent_grid(1), 0.2, 1.0, Vec2{{1e5, -1e4}}), 1));
  check({&g, 1}, turned(bent_grid(1), 0.9, 0.5, Vec2{{1e5, -1e4}}), {});
}

// Blocks, and what comes of them for fields and adjoints.
void check_operator(const Field& f, const MeshPtr& target, const TransferOptions& options,
                    std::size_t count = 3) {
  const TransferOperator whole(f.space_ptr(), target, options);
  const TransferOperator shared =
      OperatorBy::make(in_shares(count), f.space_ptr(), target, options, {});
  expect_same_geometry(shared.report(), whole.report());
  EXPECT_EQ(shared.block_count(), whole.block_count());
  expect_same(shared.transfer({&f, 1}), whole.transfer({&f, 1}));
  RandomStream random("check_operator", 1);
  std::vector<double> c(whole.target_space()->coefficient_count());
  for (double& x : c) x = random.uniform() - 0.5;
  const Field g("g", whole.target_space(), c);
  const Field other("g", shared.target_space(), c);
  EXPECT_TRUE(std::ranges::equal(shared.apply_adjoint(other).coefficients(),
                                 whole.apply_adjoint(g).coefficients()));
}

TEST(Share, OperatorsHaveTheSameBlocks) {
  const MeshPtr target = turned(test::grid_mesh(17, 1, 1.0, test::same_place), 0.3, 0.6, {});
  TransferOptions options;
  for (const int g : {1, 2}) {
    std::vector<int> degrees(bent_grid(g)->element_count());
    for (std::size_t e = 0; e < degrees.size(); ++e) degrees[e] = e < 500 ? 1 : 2;
    check_operator(wave(Space::discontinuous(bent_grid(g), degrees)), target, options);
  }
  options.degree = 1;
  check_operator(wave(Space::discontinuous(bent_grid(2), 2, Basis::physical)), target, options);
  check_operator(wave(Space::continuous(bent_grid(1), 2)), target, options, 7);
  // Sticks out on all sides: masses that extensions make, donors partly outside.
  const MeshPtr larger = turned(test::grid_mesh(17, 1, 1.0, test::same_place), 0.1, 1.05, {});
  for (const Uncovered how : {Uncovered::extend, Uncovered::zero}) {
    options.uncovered = how;
    check_operator(wave(Space::discontinuous(bent_grid(2), 1)), larger, options);
  }
}

// A triangle too small for the numbers of its mass matrix, last along the curve: what goes wrong
// in the last share is said as the whole says it.
TEST(Share, ErrorsNameElementsOfTheWhole) {
  const MeshPtr grid =
      turned(test::grid_mesh(20, 2, 1.0, test::same_place), 0.0, 1.0, Vec2{{-2.0, -2.0}});
  std::vector<Vec2> control(grid->control().begin(), grid->control().end());
  std::vector<NodeId> nodes(grid->connectivity().begin(), grid->connectivity().end());
  const double size = 1e-165;
  for (const Vec2& p : {Vec2{{0, 0}}, Vec2{{size, 0}}, Vec2{{2 * size, 0}}, Vec2{{0, size}},
                        Vec2{{size, 1.5 * size}}, Vec2{{0, 2 * size}}}) {
    nodes.emplace_back(control.size());
    control.push_back(p);
  }
  const auto target = std::make_shared<const TriangleMesh>(2, control, nodes);
  const Field f = wave(Space::discontinuous(turned(bent_grid(1), 0.1, 5.0, Vec2{{0.1, 0.2}}), 1));
  const auto message = [&](const auto& move) -> std::string {
    try {
      move();
    } catch (const NumericsError& error) {
      return error.what();
    }
    return "";
  };
  const std::string whole = message([&] { transfer({&f, 1}, target, {}); });
  EXPECT_NE(whole.find(std::to_string(grid->element_count())), std::string::npos) << whole;
  EXPECT_EQ(message([&] { transfer_by({in_shares(3)}, {&f, 1}, target, {}, {}); }), whole);
}

TEST(Message, GivesBackWhatWasWritten) {
  MessageWriter out;
  out.value(1.5);
  out.list(std::vector<int>{1, 2, 3});
  out.text("words");
  out.list(std::vector<double>{});
  const auto bytes = out.take();
  MessageReader in(bytes);
  EXPECT_EQ(in.value<double>(), 1.5);
  EXPECT_EQ(in.list<int>(), (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(in.text(), "words");
  EXPECT_TRUE(in.list<double>().empty());
  EXPECT_TRUE(in.at_end());
  EXPECT_THROW(in.value<char>(), InternalError);
}

TEST(Message, RefusesListsLongerThanItself) {
  MessageWriter out;
  out.value(std::uint64_t{1} << 62);
  const auto bytes = out.take();
  MessageReader in(bytes);
  EXPECT_THROW(in.list<double>(), InternalError);
}

}  // namespace
}  // namespace bezel::detail
