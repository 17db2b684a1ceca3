#include "bezel/field/space.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <string>

#include "bezel/base/error.hpp"
#include "checks.hpp"
#include "meshes.hpp"

namespace bezel {
namespace {

using bernstein::triangle_size;
using field_test::MeshPtr;
using field_test::message_of;

TEST(Space, DiscontinuousUniform) {
  const MeshPtr mesh = field_test::wavy(2, 3);
  for (int d = 0; d <= Space::max_degree; ++d) {
    const auto space = Space::discontinuous(mesh, d);
    EXPECT_EQ(space->basis(), Basis::reference);
    EXPECT_EQ(space->continuity(), Continuity::discontinuous);
    EXPECT_EQ(space->uniform_degree(), d);
    EXPECT_EQ(space->highest_degree(), d);
    EXPECT_EQ(space->coefficient_count(), 8u * static_cast<std::size_t>(triangle_size(d)));
    EXPECT_EQ(space->dof_count(), space->coefficient_count());
    EXPECT_EQ(space->offset(ElementId(5)), 5u * static_cast<std::size_t>(triangle_size(d)));
    EXPECT_TRUE(space->frames().empty());
    EXPECT_TRUE(space->dofs(ElementId(0)).empty());
  }
}

TEST(Space, DiscontinuousVaryingDegree) {
  const MeshPtr mesh = field_test::straight(2);
  const std::vector<int> degrees{3, 0, 10, 1, 2, 2, 5, 4};
  const auto space = Space::discontinuous(mesh, degrees, Basis::physical);
  EXPECT_EQ(space->uniform_degree(), -1);
  EXPECT_EQ(space->highest_degree(), 10);
  std::size_t offset = 0;
  for (std::size_t e = 0; e < degrees.size(); ++e) {
    EXPECT_EQ(space->degree(ElementId(e)), degrees[e]);
    EXPECT_EQ(space->offset(ElementId(e)), offset);
    offset += static_cast<std::size_t>(triangle_size(degrees[e]));
  }
  EXPECT_EQ(space->coefficient_count(), offset);
  EXPECT_EQ(space->frames().size(), 8u);
  // Equal degrees count as uniform however they were given.
  EXPECT_EQ(Space::discontinuous(mesh, std::vector<int>(8, 4))->uniform_degree(), 4);
}

TEST(Frame, IsTheElementWhenStraight) {
  // Any triangle, also a thin one, in any degree of its lattice: the corners come back, in order.
  for (const double thin : {1.0, 0.2, 1e-3, 1e-6})
    for (const double angle : {0.0, 0.4, 1.3, 2.2, 3.0, 4.5, 6.0})
      for (int g = 1; g <= 4; ++g) {
        const Vec2 along{std::cos(angle), std::sin(angle)}, across{-along.y(), along.x()};
        const std::array<Vec2, 3> corner{Vec2{0.3, 0.1}, Vec2{0.3, 0.1} + along,
                                         Vec2{0.3, 0.1} + 0.2 * along + thin * across};
        std::vector<Vec2> control;
        for (int i = 0; i < triangle_size(g); ++i) {
          const auto w = bernstein::triangle_multi_index(g, i);
          control.push_back((1.0 / g) * (corner[0] * w[0] + corner[1] * w[1] + corner[2] * w[2]));
        }
        const std::array<Vec2, 3> found = element_frame(control).corners();
        for (std::size_t k = 0; k < 3; ++k)
          EXPECT_LT(norm(found[k] - corner[k]), 4e-15 / thin) << thin << " " << angle << " " << g;
      }
}

TEST(Frame, LambdaAndPointAreInverse) {
  const std::vector<Vec2> control{{3.0, -1.0}, {4.1, 0.3}, {2.7, 0.9}};
  const Frame frame = element_frame(control);
  const Vec2 sum = frame.gradient[0] + frame.gradient[1] + frame.gradient[2];
  EXPECT_EQ(sum, (Vec2{0.0, 0.0}));
  const std::array<Vec2, 3> corner = frame.corners();
  for (std::size_t k = 0; k < 3; ++k) {
    const auto lambda = frame.lambda(corner[k]);
    for (std::size_t m = 0; m < 3; ++m) EXPECT_NEAR(lambda[m], k == m ? 1.0 : 0.0, 2e-15);
  }
  const std::array<double, 3> lambda{0.7, -0.4, 0.7};
  const auto back = frame.lambda(frame.point(lambda));
  for (std::size_t m = 0; m < 3; ++m) EXPECT_NEAR(back[m], lambda[m], 2e-15);
}

TEST(Frame, HoldsElementsOfEveryShape) {
  // Curved shapes from round to razor thin, in any direction: the frame is the smallest triangle of
  // its kind, so every control point lies inside and each side touches one.
  for (const double thin : {1.0, 0.3, 0.12, 0.1, 1e-2, 1e-4, 1e-6, 1e-8})
    for (const double angle : {0.0, 0.3, 0.785, 1.2, 1.5707, 2.5, 3.1}) {
      const Vec2 along{std::cos(angle), std::sin(angle)}, across{-along.y(), along.x()};
      std::vector<Vec2> control;
      for (const Vec2& p :
           {Vec2{0, 0}, Vec2{0.5, 0.2}, Vec2{1, 0}, Vec2{0.2, 0.6}, Vec2{0.7, 0.5}, Vec2{0.4, 1}})
        control.push_back(Vec2{2.0, 3.0} + p.x() * along + (thin * p.y()) * across);
      const Frame frame = element_frame(control);
      const double rounding = 1e-14 + 4 * 0x1p-53 * 3.7 / thin;
      std::array<double, 3> least{1, 1, 1};
      for (const Vec2& p : control)
        for (std::size_t k = 0; k < 3; ++k) least[k] = std::min(least[k], frame.lambda(p)[k]);
      for (const double l : least) EXPECT_NEAR(l, 0.0, rounding) << thin << " " << angle;
      const auto c = frame.corners();
      EXPECT_GT(cross(c[1] - c[0], c[2] - c[0]), 0.0);
    }
}

TEST(Frame, CommutesWithAffineMaps) {
  const std::vector<Vec2> control{{0.1, 0.2},   {0.7, 0.05}, {1.3, 0.1},
                                  {0.07, 0.61}, {0.9, 0.77}, {0.2, 1.1}};
  const auto map = [](const Vec2& p) {
    return Vec2{3.0 + 2.0 * p.x() - 1.5 * p.y(), -1.0 + 0.25 * p.x() + 0.5 * p.y()};
  };
  std::vector<Vec2> mapped;
  for (const Vec2& p : control) mapped.push_back(map(p));
  const auto plain = element_frame(control).corners(), image = element_frame(mapped).corners();
  for (std::size_t k = 0; k < 3; ++k) EXPECT_LT(norm(image[k] - map(plain[k])), 4e-14);
}

TEST(Frame, DegenerateElementsHaveOne) {
  // Collinear corners with a bulge (a half moon), coinciding corners, and all points on a line.
  for (const std::vector<Vec2>& control :
       {std::vector<Vec2>{{0, 0}, {1, -1}, {2, 0}, {0.5, 0}, {1.5, 0}, {1, 0}},
        std::vector<Vec2>{{0, 0}, {1, 0}, {0, 0}}, std::vector<Vec2>{{0, 0}, {1, 1}, {3, 3}}}) {
    const Frame frame = element_frame(control);
    const auto c = frame.corners();
    EXPECT_GT(cross(c[1] - c[0], c[2] - c[0]), 0.0);
    for (const Vec2& p : control)
      for (const double l : frame.lambda(p)) {
        EXPECT_GT(l, -1e-5);
        EXPECT_LT(l, 1 + 1e-5);
      }
  }
}

TEST(Frame, Errors) {
  EXPECT_EQ(message_of([] { element_frame({}); }),
            "an element frame needs control points, found none");
  EXPECT_EQ(message_of([] {
              element_frame(std::vector<Vec2>(3, Vec2{1.0, 2.0}));
            }),
            "all control points of an element coincide, expected a triangle");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(message_of([&] {
              element_frame(std::vector<Vec2>{{0, 0}, {1, nan}, {0, 1}});
            }),
            "a control point is not finite");
}

TEST(Space, GivenFramesAreKept) {
  const MeshPtr mesh = field_test::two_quadratic();
  const auto made = Space::discontinuous(mesh, 3, Basis::physical);
  std::vector<Frame> frames(made->frames().begin(), made->frames().end());
  frames[1].centre = {0.5, 0.25};
  const auto space = Space::discontinuous(mesh, std::vector<int>{3, 2}, frames);
  EXPECT_EQ(space->basis(), Basis::physical);
  EXPECT_EQ(space->frame(ElementId(0)), made->frame(ElementId(0)));
  EXPECT_EQ(space->frame(ElementId(1)), frames[1]);
}

TEST(Space, ContinuousCounts) {
  for (int g = 1; g <= 3; ++g) {
    const MeshPtr mesh = field_test::wavy(3, g);
    EXPECT_EQ(mesh->vertex_count(), 16u);
    EXPECT_EQ(mesh->edge_count(), 33u);
    for (int d = 1; d <= Space::max_degree; ++d) {
      const auto space = Space::continuous(mesh, d);
      EXPECT_EQ(space->continuity(), Continuity::continuous);
      EXPECT_EQ(space->basis(), Basis::reference);
      // The domain points are those of the (3d+1)^2 grid.
      EXPECT_EQ(space->dof_count(), static_cast<std::size_t>((3 * d + 1) * (3 * d + 1)));
      EXPECT_EQ(space->coefficient_count(), 18u * static_cast<std::size_t>(triangle_size(d)));
      std::set<std::int32_t> used;
      for (std::size_t e = 0; e < 18; ++e)
        for (const std::int32_t dof : space->dofs(ElementId(e))) used.insert(dof);
      EXPECT_EQ(used.size(), space->dof_count());
      EXPECT_EQ(*used.begin(), 0);
    }
  }
}

TEST(Space, ContinuousDofsHaveOnePlace) {
  // On a straight mesh the Bernstein domain points of equal dofs coincide and those of different
  // dofs differ.
  const MeshPtr mesh = field_test::straight(3, 2);
  const int d = 5;
  const auto space = Space::continuous(mesh, d);
  std::map<std::int32_t, Vec2> place;
  std::set<std::pair<long, long>> places;
  int shared = 0;
  for (std::size_t e = 0; e < mesh->element_count(); ++e) {
    const auto control = mesh->gather(ElementId(e));
    for (int i = 0; i < triangle_size(d); ++i) {
      const auto w = bernstein::triangle_multi_index(d, i);
      Vec2 p{};
      for (int k = 0; k < 3; ++k)
        p += control[static_cast<std::size_t>(bernstein::triangle_corner(2, k))] *
             (w[static_cast<std::size_t>(k)] / 5.0);
      const std::int32_t dof = space->dofs(ElementId(e))[static_cast<std::size_t>(i)];
      const auto [it, fresh] = place.emplace(dof, p);
      if (fresh) {
        places.emplace(std::lround(p.x() * 1e6), std::lround(p.y() * 1e6));
      } else {
        ++shared;
        EXPECT_LT(norm(it->second - p), 1e-14) << "dof " << dof;
      }
    }
  }
  EXPECT_EQ(places.size(), space->dof_count());
  EXPECT_GT(shared, 100);
}

TEST(Space, ContinuousNumberingAsDocumented) {
  const MeshPtr mesh = field_test::wavy(2, 2);
  const int d = 4, g = 2;
  const auto space = Space::continuous(mesh, d);
  int reversed = 0;
  for (std::size_t e = 0; e < mesh->element_count(); ++e) {
    const auto dofs = space->dofs(ElementId(e));
    const auto nodes = mesh->nodes(ElementId(e));
    for (int a = 0; a < 3; ++a) {
      const auto dof = dofs[static_cast<std::size_t>(bernstein::triangle_corner(d, a))];
      EXPECT_LT(dof, static_cast<std::int32_t>(mesh->vertex_count()));
      for (int b = 0; b < 3; ++b)  // ascending with NodeId
        EXPECT_EQ(dof < dofs[static_cast<std::size_t>(bernstein::triangle_corner(d, b))],
                  nodes[static_cast<std::size_t>(bernstein::triangle_corner(g, a))] <
                      nodes[static_cast<std::size_t>(bernstein::triangle_corner(g, b))]);
    }
    for (int side = 0; side < 3; ++side) {
      const SideEdge edge = mesh->edges(ElementId(e))[static_cast<std::size_t>(side)];
      reversed += edge.reversed ? 1 : 0;
      for (int m = 1; m < d; ++m) {
        const int along = edge.reversed ? d - m : m;
        EXPECT_EQ(dofs[static_cast<std::size_t>(bernstein::triangle_side_index(d, side, m))],
                  static_cast<std::int32_t>(mesh->vertex_count()) + edge.edge.value * (d - 1) +
                      along - 1);
      }
    }
    const auto inner =
        static_cast<std::int32_t>(mesh->vertex_count() + mesh->edge_count() * 3 + e * 3);
    EXPECT_EQ(dofs[static_cast<std::size_t>(bernstein::triangle_index(d, 1, 1))], inner);
    EXPECT_EQ(dofs[static_cast<std::size_t>(bernstein::triangle_index(d, 2, 1))], inner + 1);
    EXPECT_EQ(dofs[static_cast<std::size_t>(bernstein::triangle_index(d, 1, 2))], inner + 2);
  }
  EXPECT_GT(reversed, 3);
}

TEST(Space, Expand) {
  const MeshPtr mesh = field_test::straight(1);
  const auto space = Space::continuous(mesh, 1);
  ASSERT_EQ(space->dof_count(), 4u);
  const std::vector<double> c = space->expand(std::vector<double>{1, 10, 2, 20, 3, 30, 4, 40}, 2);
  ASSERT_EQ(c.size(), 12u);
  for (std::size_t e = 0; e < 2; ++e)
    for (std::size_t i = 0; i < 3; ++i) {
      const double dof = space->dofs(ElementId(e))[i];
      EXPECT_EQ(c[(e * 3 + i) * 2], dof + 1);
      EXPECT_EQ(c[(e * 3 + i) * 2 + 1], 10 * (dof + 1));
    }
  const auto loose = Space::discontinuous(mesh, 1);
  const std::vector<double> dofs{1, 2, 3, 4, 5, 6};
  EXPECT_EQ(loose->expand(dofs), dofs);
}

TEST(Space, Errors) {
  const MeshPtr mesh = field_test::straight(1);
  EXPECT_EQ(message_of([] { Space::discontinuous(nullptr, 1); }),
            "a space needs a mesh, found a null pointer");
  EXPECT_EQ(message_of([] { Space::continuous(nullptr, 1); }),
            "a space needs a mesh, found a null pointer");
  EXPECT_EQ(message_of([&] { Space::discontinuous(mesh, 11); }),
            "field degree 11 is not supported, expected 0..10");
  EXPECT_EQ(message_of([&] { Space::discontinuous(mesh, -1); }),
            "field degree -1 is not supported, expected 0..10");
  EXPECT_EQ(message_of([&] { Space::continuous(mesh, 0); }),
            "field degree 0 is not supported, expected 1..10");
  EXPECT_EQ(message_of([&] {
              Space::discontinuous(mesh, std::vector<int>{1, 12});
            }),
            "triangle 1: field degree 12 is not supported, expected 0..10");
  EXPECT_EQ(message_of([&] { Space::discontinuous(mesh, std::vector<int>{1}); }),
            "found 1 degrees, expected one for each of the 2 elements");
  EXPECT_EQ(message_of([&] {
              Space::discontinuous(mesh, std::vector<int>{1, 1, 1}, Basis::physical);
            }),
            "found 3 degrees, expected one for each of the 2 elements");
  EXPECT_EQ(message_of([&] { Space::continuous(mesh, 2, Basis::physical); }),
            "a continuous space cannot use the physical basis: it is non-conforming on curved "
            "edges; use the "
            "reference basis, or a discontinuous space");
  EXPECT_EQ(message_of([&] { Space::continuous(mesh, 2)->expand(std::vector<double>(3)); }),
            "found 3 values, expected 9 (degrees of freedom 9 x components 1)");
  EXPECT_EQ(message_of([&] { Space::continuous(mesh, 2)->expand(std::vector<double>(9), 0); }),
            "found 0 components, expected at least 1");
  try {
    Space::discontinuous(mesh, std::vector<int>{1, 12});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.place().element_kind, "triangle");
    EXPECT_EQ(error.place().element, 1);
  }
}

TEST(Space, FrameErrors) {
  const MeshPtr mesh = field_test::straight(1);
  const auto made = Space::discontinuous(mesh, 2, Basis::physical);
  const auto good = made->frames();
  const auto with = [&](const std::function<void(Frame&)>& spoil) {
    std::vector<Frame> frames(good.begin(), good.end());
    spoil(frames[1]);
    return message_of([&] { Space::discontinuous(mesh, std::vector<int>{2, 2}, frames); });
  };
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(with([&](Frame& f) { f.centre[0] = infinity; }),
            "triangle 1: frame: the centre is not finite");
  EXPECT_EQ(with([&](Frame& f) { f.gradient[2][1] = infinity; }),
            "triangle 1: frame: a gradient is not finite");
  EXPECT_EQ(with([&](Frame& f) { f.gradient[2][1] += 0.01; }),
            "triangle 1: frame: the three gradients must add up to zero");
  EXPECT_EQ(with([&](Frame& f) {
              f.gradient[1] = f.gradient[0];
              f.gradient[2] = -2.0 * f.gradient[0];
            }),
            "triangle 1: frame: the gradients are parallel, expected a triangle with an area");
  EXPECT_EQ(message_of([&] {
              Space::discontinuous(mesh, std::vector<int>{2, 2}, std::vector<Frame>(1));
            }),
            "found 1 frames, expected one for each of the 2 elements");
}

}  // namespace
}  // namespace bezel
