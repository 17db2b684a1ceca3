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

// Values move by the rounding of the conversions and of the evaluation; largest seen 1.2e-15 (VTU
// with geometry and fields raised), values of order 1.
constexpr double tolerance = 1e-14;

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
    EXPECT_LE(geometry_difference(*data.mesh, *back.mesh), tolerance);
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
      EXPECT_LE(field_difference(field, other), tolerance);
    }
    if (form.format == Format::native) {
      EXPECT_TRUE(same_bits(data, back));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Degrees, RoundTrip, ::testing::Range(1, 11));

Dataset small(int g = 2) {
  Dataset data;
  data.mesh = io_test::disc(g, 2.0);
  return data;
}

TEST(Write, SaysWhatTheFormatCouldNotKeep) {
  Dataset data;
  data.mesh = io_test::tagged_disc(2);
  std::vector<std::string> lost;
  pass(data, {"native", Format::native}, &lost);
  EXPECT_THAT(lost, IsEmpty());
  pass(data, {"msh41", Format::msh41_binary}, &lost);
  EXPECT_THAT(lost, IsEmpty());
  pass(data, {"msh22", Format::msh22_binary}, &lost);
  EXPECT_THAT(lost,
              ElementsAre("MSH 2.2 names one physical group per element: of 1 entities in several "
                          "groups others than bezel see the first only"));
  data = small();
  data.fields = {
      io_test::wavy("p", Space::discontinuous(data.mesh, 2, Basis::physical)),
      io_test::wavy("hp", Space::discontinuous(data.mesh, io_test::varying_degrees(
                                                              data.mesh->element_count(), 1, 3)))};
  pass(data, {"msh41", Format::msh41_binary}, &lost);
  EXPECT_THAT(lost, ElementsAre("field 'p': degree 2 in x and y, written as degree 4 in reference "
                                "coordinates; bezel restores it",
                                "field 'hp': its degree varies from element to element, written as "
                                "degree 3 everywhere; bezel restores it"));
  pass(data, {"vtu", Format::vtu}, &lost);
  EXPECT_EQ(lost.size(), 3U);
  EXPECT_EQ(lost[0],
            "the geometry, degree 2, is written as degree 4 like the highest field; bezel "
            "restores it");
  pass(data, {"native", Format::native}, &lost);
  EXPECT_THAT(lost, IsEmpty());
}

std::string write_error(const Dataset& data, const std::string& name) {
  const Folder folder;
  try {
    write(folder / name, data);
  } catch (const InputError& error) {
    EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "a file was left";
    EXPECT_EQ(error.place().file, folder / name);
    return error.message();
  }
  return "no error";
}

TEST(Write, RefusesWhatItCannotHoldAndLeavesNoFile) {
  EXPECT_EQ(write_error(Dataset{}, "f.vtu"), "found no mesh, expected one to write");
  Dataset data = small(6);
  data.fields = {io_test::wavy("f", Space::discontinuous(data.mesh, 2, Basis::physical))};
  const std::string too_high =
      "field 'f': degree 2 in x and y on elements of degree 6 is degree 12 in reference "
      "coordinates, "
      "this format holds at most 10; the native format (.bzl) keeps it";
  EXPECT_EQ(write_error(data, "f.msh"), too_high);
  EXPECT_EQ(write_error(data, "f.vtu"), too_high);
  EXPECT_EQ(write_error(data, "f.bzl"), "no error");
  data = small();
  data.fields = {io_test::wavy("f", Space::discontinuous(data.mesh, 1)),
                 io_test::wavy("f", Space::discontinuous(data.mesh, 2))};
  EXPECT_EQ(write_error(data, "f.msh"), "two fields are named 'f', expected different names");
  data.fields = {io_test::wavy("f", Space::discontinuous(io_test::disc(1), 1))};
  EXPECT_EQ(write_error(data, "f.msh"), "field 'f' is on another mesh than the one to write");
  data.fields = {io_test::wavy("a\"b", Space::discontinuous(data.mesh, 1))};
  EXPECT_EQ(write_error(data, "f.msh"),
            "field 'a\"b' has a character that MSH cannot hold, expected no quotes or line breaks");
  EXPECT_EQ(write_error(data, "f.vtu"), "no error");
  data.fields = {io_test::wavy("a\nb", Space::discontinuous(data.mesh, 1))};
  EXPECT_EQ(write_error(data, "f.vtu"),
            "a field name has a control character, which VTU cannot hold");
  data.fields = {
      io_test::wavy("a\xff"
                    "b",
                    Space::discontinuous(data.mesh, 1))};
  EXPECT_EQ(write_error(data, "f.vtu"), "a name of a field or physical group is not UTF-8 text");
}

TEST(Read, NamesAMissingFile) {
  EXPECT_THROW(read("/nonexistent/x.msh"), InputError);
}

TEST(FormatOf, KnowsTheExtensions) {
  EXPECT_EQ(format_of("a/b.msh"), Format::msh41_binary);
  EXPECT_EQ(format_of("b.vtu"), Format::vtu);
  EXPECT_EQ(format_of("b.x.bzl"), Format::native);
  try {
    format_of("wing.stl");
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "wing.stl: unknown extension '.stl', expected .msh, .vtu or .bzl");
  }
  EXPECT_EQ(to_string(Format::msh22_ascii), "msh22_ascii");
  EXPECT_EQ(to_string(Format::native), "native");
}

std::string field_error(const Dataset& data, const std::string& name) {
  try {
    data.field(name);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(DatasetField, FindsByNameOrTheOnlyOne) {
  Dataset data = small();
  EXPECT_EQ(field_error(data, ""), "there are no fields, expected one");
  EXPECT_EQ(field_error(data, "u"), "there is no field 'u', there are no fields");
  const auto space = Space::discontinuous(data.mesh, 1);
  data.fields = {io_test::wavy("u", space)};
  EXPECT_EQ(data.field().name(), "u");
  data.fields.push_back(io_test::wavy("v", space));
  EXPECT_EQ(data.field("v").name(), "v");
  EXPECT_EQ(field_error(data, ""), "there are 2 fields, expected the name of one: 'u', 'v'");
  EXPECT_EQ(field_error(data, "w"), "there is no field 'w', there are 'u', 'v'");
}

// Copies between neighbours must be the same bits: converted once per edge, in one direction.
TEST(Read, NeighboursShareControlPoints) {
  for (const int g : {2, 5, 10}) {
    const Dataset data{io_test::disc(g), {}, {}, {}};
    for (const Form& form : forms()) {
      const Dataset back = pass(data, form);
      EXPECT_EQ(back.mesh->node_count(), data.mesh->node_count()) << form.name;
      EXPECT_TRUE(std::equal(data.mesh->connectivity().begin(), data.mesh->connectivity().end(),
                             back.mesh->connectivity().begin()))
          << form.name;
    }
  }
}

// A hanging vertex: the node in the middle of a long straight edge is a corner of two neighbours.
// MSH and VTU need a copy of it, for the value at the middle is not the control point.
TEST(RoundTripNodes, ANodeThatPlaysTwoPartsIsCopied) {
  const std::vector<Vec2> control{{0, 0}, {2, 0},  {0, 2},   {1, 0},    {1, 1.5},
                                  {0, 1}, {1, -1}, {0.5, 0}, {1, -0.5}, {0.5, -0.5}};
  const auto id = [](int n) { return NodeId(static_cast<std::int32_t>(n)); };
  Dataset data;
  data.mesh = std::make_shared<TriangleMesh>(
      2, control,
      std::vector<NodeId>{id(0), id(3), id(1), id(5), id(4), id(2),    // 3 inside its bottom edge
                          id(0), id(9), id(6), id(7), id(8), id(3)});  // 3 a corner
  for (const Form& form : forms()) {
    const Dataset back = pass(data, form);
    EXPECT_LE(geometry_difference(*data.mesh, *back.mesh), 1e-15) << form.name;
  }
}

}  // namespace
}  // namespace bezel
