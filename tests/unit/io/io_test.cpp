#include "bezel/io/io.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/triangle.hpp"
#include "tests/unit/io/datasets.hpp"

namespace bezel {
namespace {

using bernstein::Lambda;
using io_test::Folder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct Form {
  std::string name;
  Format format;
  bool bezier = false, compress = true;
  std::string file() const {
    return format == Format::vtu ? "f.vtu" : format == Format::native ? "f.bzl" : "f.msh";
  }
};

const std::vector<Form>& forms() {
  static const std::vector<Form> all{{"msh22_ascii", Format::msh22_ascii},
                                     {"msh22_binary", Format::msh22_binary},
                                     {"msh41_ascii", Format::msh41_ascii},
                                     {"msh41_binary", Format::msh41_binary},
                                     {"vtu_lagrange", Format::vtu},
                                     {"vtu_bezier", Format::vtu, true},
                                     {"vtu_plain", Format::vtu, false, false},
                                     {"native", Format::native}};
  return all;
}

Dataset pass(const Dataset& data, const Form& form, std::vector<std::string>* lost = nullptr) {
  const Folder folder;
  const std::string path = folder / form.file();
  const auto sentences = write(path, data, {form.format, form.bezier, form.compress});
  if (lost) *lost = sentences;
  return read(path);
}

std::vector<Lambda> probes() {
  return {{1, 0, 0},
          {0, 1, 0},
          {0, 0, 1},
          {0.5, 0.5, 0},
          {0.25, 0, 0.75},
          {0, 0.3, 0.7},
          {1.0 / 3, 1.0 / 3, 1.0 / 3},
          {0.1, 0.2, 0.7},
          {0.6, 0.15, 0.25}};
}

/// Largest distance of equal parameters' points.
double geometry_difference(const TriangleMesh& a, const TriangleMesh& b) {
  double worst = 0.0;
  for (std::size_t e = 0; e < a.element_count(); ++e)
    for (const Lambda& l : probes()) {
      const auto pa = a.gather(ElementId(e)), pb = b.gather(ElementId(e));
      const Vec2 d = bernstein::evaluate<Vec2>(a.degree(), pa, l) -
                     bernstein::evaluate<Vec2>(b.degree(), pb, l);
      worst = std::max(worst, norm(d));
    }
  return worst;
}

double field_difference(const Field& a, const Field& b) {
  double worst = 0.0;
  const auto n = static_cast<std::size_t>(a.components());
  std::vector<double> va(n), vb(n);
  for (std::size_t e = 0; e < a.mesh().element_count(); ++e)
    for (const Lambda& l : probes()) {
      a.evaluate(ElementId(e), l, va);
      b.evaluate(ElementId(e), l, vb);
      for (std::size_t c = 0; c < n; ++c) worst = std::max(worst, std::abs(va[c] - vb[c]));
    }
  return worst;
}

bool same_bits(const Dataset& a, const Dataset& b) {
  const auto equal = [](auto x, auto y) {
    return std::equal(x.begin(), x.end(), y.begin(), y.end());
  };
  bool same = equal(a.mesh->control(), b.mesh->control()) &&
              equal(a.mesh->connectivity(), b.mesh->connectivity()) &&
              a.mesh->tags() == b.mesh->tags() && a.time == b.time &&
              a.fields.size() == b.fields.size();
  for (std::size_t i = 0; same && i < a.fields.size(); ++i) {
    const Field &f = a.fields[i], &g = b.fields[i];
    same = f.name() == g.name() && f.components() == g.components() &&
           f.space().basis() == g.space().basis() &&
           f.space().continuity() == g.space().continuity() &&
           f.space().uniform_degree() == g.space().uniform_degree() &&
           equal(f.coefficients(), g.coefficients()) &&
           equal(f.space().frames(), g.space().frames());
  }
  return same;
}

/// Everything there is, on a mesh of degree g.
Dataset everything(int g) {
  Dataset data;
  data.mesh = io_test::tagged_disc(g);
  data.time = 0.1;
  const auto& mesh = data.mesh;
  const int low = std::max(1, g - 2), high = std::min(10, g + 1);
  data.fields.push_back(io_test::wavy("nodal", Space::continuous(mesh, g)));
  data.fields.push_back(io_test::wavy("velocity", Space::continuous(mesh, low), 2));
  data.fields.push_back(io_test::wavy("jumps", Space::discontinuous(mesh, high), 3));
  data.fields.push_back(io_test::wavy("cells", Space::discontinuous(mesh, 0)));
  data.fields.push_back(io_test::wavy(
      "hp", Space::discontinuous(mesh, io_test::varying_degrees(mesh->element_count(), 0, high))));
  data.fields.push_back(io_test::wavy("tensor", Space::discontinuous(mesh, g), 4));
  const int p = 10 / g >= 2 ? 2 : 1;
  data.fields.push_back(io_test::wavy("physical", Space::discontinuous(mesh, p, Basis::physical)));
  return data;
}

// Conversions between nodal values and Bernstein coefficients of degree d round with at most about
// d^2 u times the condition number of equally spaced nodes, below 2^d; the values themselves move
// by the Lebesgue constant (below 2^d / d) times u.
double tolerance(int degree) {
  return 1e-15 * (16.0 + std::pow(2.0, degree));
}

class RoundTrip : public ::testing::TestWithParam<int> {};

TEST_P(RoundTrip, KeepsMeshTagsAndFields) {
  const int g = GetParam();
  const Dataset data = everything(g);
  for (const Form& form : forms()) {
    SCOPED_TRACE(form.name);
    const Dataset back = pass(data, form);
    ASSERT_EQ(back.mesh->degree(), g);
    ASSERT_EQ(back.mesh->element_count(), data.mesh->element_count());
    EXPECT_EQ(back.mesh->edge_count(), data.mesh->edge_count());
    EXPECT_EQ(back.mesh->vertex_count(), data.mesh->vertex_count());
    EXPECT_THAT(back.notes, IsEmpty());
    EXPECT_EQ(back.time, data.time);
    EXPECT_LE(geometry_difference(*data.mesh, *back.mesh), 2 * tolerance(g));
    EXPECT_EQ(back.mesh->tags().groups, data.mesh->tags().groups);
    EXPECT_EQ(back.mesh->tags().entities, data.mesh->tags().entities);
    EXPECT_EQ(back.mesh->tags().element_entity, data.mesh->tags().element_entity);
    ASSERT_EQ(back.mesh->tags().edges.size(), data.mesh->tags().edges.size());
    EXPECT_EQ(back.mesh->tags().points.size(), data.mesh->tags().points.size());
    if (form.format != Format::vtu) {
      EXPECT_EQ(back.mesh->tags(), data.mesh->tags());
    }
    for (std::size_t i = 0; i < data.mesh->tags().edges.size(); ++i) {
      const TaggedEdge &a = data.mesh->tags().edges[i], &b = back.mesh->tags().edges[i];
      EXPECT_EQ(a.entity, b.entity);
      EXPECT_LE(norm(data.mesh->control(a.nodes.front()) - back.mesh->control(b.nodes.front())),
                0.0);
    }
    ASSERT_EQ(back.fields.size(), data.fields.size());
    for (const Field& field : data.fields) {
      SCOPED_TRACE(field.name());
      const Field& other = back.field(field.name());
      EXPECT_EQ(other.components(), field.components());
      EXPECT_EQ(other.space().basis(), field.space().basis());
      EXPECT_EQ(other.space().continuity(), field.space().continuity());
      EXPECT_EQ(other.space().uniform_degree(), field.space().uniform_degree());
      for (std::size_t e = 0; e < back.mesh->element_count(); ++e)
        EXPECT_EQ(other.space().degree(ElementId(e)), field.space().degree(ElementId(e)));
      EXPECT_LE(field_difference(field, other), 4 * tolerance(10));
    }
    if (form.format == Format::native) {
      EXPECT_TRUE(same_bits(data, back));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Degrees, RoundTrip, ::testing::Range(1, 11));

}  // namespace
}  // namespace bezel
