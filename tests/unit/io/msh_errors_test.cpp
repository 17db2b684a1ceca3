// Every documented error of MSH files, by type and message.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bezel/base/error.hpp"
#include "bezel/io/msh.hpp"
#include "tests/unit/io/datasets.hpp"

namespace bezel {
namespace {

using ::testing::HasSubstr;

std::string error_of(const std::string& bytes) {
  try {
    files::read_msh("x.msh", bytes);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

/// Replaces the first occurrence.
std::string with(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  if (at == std::string::npos) throw std::logic_error("nothing to replace: " + what);
  return text.replace(at, what.size(), by);
}

const std::string v2 =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"                             // lines 1-3
    "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n"         // 4-10
    "$Elements\n2\n11 2 2 0 1 1 2 3\n12 2 2 0 1 1 3 4\n$EndElements\n";  // 11-15

const std::string v4 =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
    "$Entities\n0 0 1 0\n1 0 0 0 1 1 0 0 0\n$EndEntities\n"
    "$Nodes\n1 4 1 4\n2 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n$EndNodes\n"
    "$Elements\n1 2 11 12\n2 1 2 2\n11 1 2 3\n12 1 3 4\n$EndElements\n";

std::string data2(const std::string& section, const std::string& values, int components = 1,
                  int count = 2, const std::string& scheme = "") {
  return v2 + "$" + section + "\n" +
         (scheme.empty() ? "1\n\"u\"\n" : "2\n\"u\"\n\"" + scheme + "\"\n") + "1\n0.5\n3\n0\n" +
         std::to_string(components) + "\n" + std::to_string(count) + "\n" + values + "$End" +
         section + "\n";
}

TEST(MshErrors, TheExamplesAreValid) {
  EXPECT_EQ(error_of(v2), "no error");
  EXPECT_EQ(error_of(v4), "no error");
  EXPECT_EQ(error_of(data2("ElementData", "11 1\n12 2\n")), "no error");
}

TEST(MshErrors, Header) {
  EXPECT_EQ(error_of(""), "x.msh:1: the file ends where '$MeshFormat' was expected");
  EXPECT_EQ(error_of("solid cube\n"), "x.msh:1: expected '$MeshFormat', found 'solid'");
  EXPECT_EQ(error_of(with(v2, "2.2", "4.0")),
            "x.msh:2: MSH version 4.0 is not supported, expected 2.2 or 4.1");
  EXPECT_EQ(error_of(with(v2, "2.2 0 8", "2.2 7 8")),
            "x.msh:2: file type 7 is not 0 (text) or 1 (binary)");
  EXPECT_EQ(error_of(with(v2, "2.2 0 8", "2.2 0 4")),
            "x.msh:2: data size 4 is not supported, expected 8");
  EXPECT_EQ(error_of(std::string("$MeshFormat\n2.2 1 8\n\2\0\0\0\n$EndMeshFormat\n", 40)),
            "x.msh: the byte order mark is 2, expected 1 in either byte order (at byte 20)");
}

TEST(MshErrors, Sections) {
  EXPECT_EQ(error_of("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"),
            "x.msh:3: the file has no $Nodes section");
  EXPECT_EQ(error_of(v2.substr(0, v2.find("$Elements"))),
            "x.msh:10: the file has no $Elements section");
  EXPECT_EQ(error_of(with(v2, "$EndNodes", "$EndNode")),
            "x.msh:10: expected '$EndNodes', found '$EndNode'");
  EXPECT_EQ(error_of(v2 + "hello\n"), "x.msh:16: expected a section such as $Nodes, found 'hello'");
  EXPECT_EQ(error_of(v2 + "$Foo\n1 2 3\n"),
            "x.msh:16: section $Foo is not closed, expected $EndFoo");
  EXPECT_EQ(error_of(v2 + v2.substr(v2.find("$Nodes"))),
            "x.msh:16: a second $Nodes section, expected one");
}

TEST(MshErrors, Nodes) {
  EXPECT_EQ(
      error_of(with(v2, "$Nodes\n4\n", "$Nodes\n1000000000000\n")),
      "x.msh:5: the number of nodes is 1000000000000, more than the 102 bytes left in the file "
      "can hold");
  EXPECT_EQ(error_of(with(v2, "$Nodes\n4\n", "$Nodes\n-4\n")),
            "x.msh:5: the number of nodes is -4, expected 0 or more");
  EXPECT_EQ(error_of(with(v2, "3 1 1 0\n", "3 nan 1 0\n")),
            "x.msh:8: node 3: x is nan, expected a finite number");
  EXPECT_EQ(error_of(with(v2, "3 1 1 0\n", "3 1 one 0\n")),
            "x.msh:8: expected y (a number), found 'one'");
  EXPECT_EQ(error_of(with(v2, "3 1 1 0\n", "2 1 1 0\n")), "x.msh: node 2: it is given twice");
  EXPECT_EQ(error_of(with(v2, "3 1 1 0\n", "3 1 1 0.25\n")),
            "x.msh: node 3: z is 0.25, expected a planar mesh (z = 0 as at node 1)");
  EXPECT_EQ(error_of(with(v4, "2 1 0 4\n", "2 1 0 5\n")),
            "x.msh:10: the node blocks hold more than the 4 nodes announced");
  EXPECT_EQ(error_of(with(v4, "1 4 1 4\n", "1 5 1 4\n")),
            "x.msh:18: the node blocks hold 4 nodes, 5 were announced");
}

TEST(MshErrors, Elements) {
  EXPECT_EQ(
      error_of(with(v2, "12 2 2 0 1 1 3 4", "12 3 2 0 1 1 2 3 4")),
      "x.msh:14: element 12: type 3 (4-node quadrangle) is not supported, expected triangles of "
      "degree 1 to 10");
  EXPECT_EQ(
      error_of(with(v4, "2 1 2 2\n11 1 2 3", "3 1 4 2\n11 1 2 3 4")),
      "x.msh:23: element 11: type 4 (4-node tetrahedron) is not supported, expected triangles "
      "of degree 1 to 10");
  EXPECT_EQ(error_of(with(v2, "12 2 2 0 1 1 3 4", "12 9 2 0 1 1 3 4 1 2 3")),
            "x.msh:14: element 12: type 9 (6-node triangle) has degree 2, the triangles before it "
            "degree 1; expected one degree");
  EXPECT_EQ(
      error_of(with(v2, "12 2 2 0 1 1 3 4", "12 8 2 0 1 1 3 4")),
      "x.msh: element 12: a line of degree 2, the triangles have degree 1; expected one degree");
  EXPECT_EQ(error_of(with(v2, "12 2 2 0 1 1 3 4", "12 2 2 0 1 1 3 99")),
            "x.msh:14: element 12: node 99 does not exist, the file has 4");
  EXPECT_EQ(error_of(with(v2, "12 2 2 0 1 1 3 4", "11 2 2 0 1 1 3 4")),
            "x.msh: element 11: it is given twice");
  EXPECT_EQ(error_of(with(v2, "12 2 2 0 1 1 3 4", "12 2 2 0 1 1 3 3")),
            "x.msh: element 12: two of its corners are node 3, expected different nodes");
  EXPECT_EQ(error_of(with(v4, "2 1 2 2\n", "1 1 2 2\n")),
            "x.msh:23: element 11: type 2 (3-node triangle) in an entity of dimension 1, expected "
            "dimension 2");
  EXPECT_EQ(error_of(with(v4, "1 2 11 12\n", "1 1 11 12\n")),
            "x.msh:22: the element blocks hold more than the 1 elements announced");
  EXPECT_EQ(
      error_of(with(v2, "$Elements\n2\n11 2 2 0 1 1 2 3\n12 2 2 0 1 1 3 4\n", "$Elements\n0\n")),
      "x.msh: the file has no triangles");
  EXPECT_EQ(error_of(v2.substr(0, v2.find("3 4\n$EndEl"))),
            "x.msh:14: the file ends where a node of an element was expected");
}

TEST(MshErrors, Fields) {
  EXPECT_EQ(error_of(data2("NodeData", "1 1\n2 2\n")), "x.msh: field 'u': node 3 has no value");
  EXPECT_EQ(error_of(data2("NodeData", "1 1\n77 2\n")),
            "x.msh: field 'u': node 77 does not exist, the file has 4");
  EXPECT_EQ(error_of(data2("NodeData", "1 1\n1 2\n")),
            "x.msh: field 'u': node 1 has two values, expected one");
  EXPECT_EQ(error_of(data2("ElementData", "11 1\n11 2\n")),
            "x.msh: field 'u': element 11 has two values, expected one");
  EXPECT_EQ(error_of(data2("ElementData", "11 1\n", 1, 1)),
            "x.msh: field 'u': element 12 has no value");
  EXPECT_EQ(error_of(data2("ElementData", "11 1\n12 inf\n")),
            "x.msh:26: element 12: field 'u' is inf, expected a finite number");
  EXPECT_EQ(error_of(data2("ElementData", "11 1\n12 2\n", 12)),
            "x.msh:23: the number of components is 12, expected 1 to 9");
  EXPECT_EQ(error_of(data2("ElementData", "11 1\n12 2\n", 1, 2000000000)),
            "x.msh:24: the number of values is 2000000000, more than the 27 bytes left in the file "
            "can hold");
  EXPECT_EQ(error_of(data2("ElementNodeData", "11 3 1 2 3\n12 4 1 2 3 4\n")),
            "x.msh: field 'u': element 12 has 4 values, expected 3");
  EXPECT_EQ(
      error_of(data2("ElementNodeData", "11 6 1 2 3 4 5 6\n12 6 1 2 3 4 5 6\n")),
      "x.msh: field 'u': element 11 has 6 values without an interpolation scheme, expected 3");
  EXPECT_EQ(error_of(data2("ElementNodeData", "11 3 1 2 3\n12 3 1 2 3\n", 1, 2, "mine")),
            "x.msh: field 'u': interpolation scheme 'mine' is not in the file (for triangles)");
  const auto scheme = [](const std::string& exponents) {
    return "$InterpolationScheme\n\"s\"\n1\n3\n2\n1 1\n1\n1 3\n" + exponents +
           "\n$EndInterpolationScheme\n";
  };
  const std::string field = data2("ElementNodeData", "11 1 1\n12 1 2\n", 1, 2, "s");
  EXPECT_EQ(error_of(with(field, "$ElementNodeData", scheme("0 0 0") + "$ElementNodeData")),
            "no error");
  EXPECT_EQ(error_of(with(field, "$ElementNodeData", scheme("6 5 0") + "$ElementNodeData")),
            "x.msh: field 'u': interpolation scheme 's' has degree 11, expected at most 10");
  EXPECT_EQ(error_of(with(field, "$ElementNodeData", scheme("0 0.5 0") + "$ElementNodeData")),
            "x.msh: field 'u': exponent 0.5 in interpolation scheme 's', expected 0 to 10");
  EXPECT_EQ(
      error_of(with(field, "$ElementNodeData", scheme("0 0 1") + "$ElementNodeData")),
      "x.msh: field 'u': exponent 1 in interpolation scheme 's', expected 0 to 0 for the third "
      "variable");
}

TEST(MshErrors, MembersNameThePlace) {
  try {
    files::read_msh("x.msh", with(v2, "12 2 2 0 1 1 3 4", "12 3 2 0 1 1 2 3 4"));
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_EQ(error.place().file, "x.msh");
    EXPECT_EQ(error.place().line, 14);
    EXPECT_EQ(error.place().element_kind, "element");
    EXPECT_EQ(error.place().element, 12);
  }
}

TEST(MshErrors, BinaryCountsAreNotBelieved) {
  std::string bytes("$MeshFormat\n4.1 1 8\n\1\0\0\0\n$EndMeshFormat\n$Nodes\n", 47);
  for (const std::uint64_t n : {std::uint64_t{1}, std::uint64_t{1000000000000}, std::uint64_t{1},
                                std::uint64_t{1000000000000}})
    bytes.append(reinterpret_cast<const char*>(&n), 8);
  EXPECT_EQ(
      error_of(bytes),
      "x.msh: the number of nodes is 1000000000000, more than the 16 bytes left in the file can "
      "hold (at byte 55)");
}

TEST(MshErrors, TruncatedBinaryNamesTheByte) {
  Dataset data;
  data.mesh = io_test::disc(2);
  std::vector<std::string> lost;
  const std::string bytes = files::write_msh(data, Format::msh41_binary, lost);
  EXPECT_THAT(error_of(bytes.substr(0, bytes.find("$EndElements") - 5)),
              HasSubstr("the file ends where a node of an element was expected (at byte "));
}

TEST(MshErrors, MetadataIsChecked) {
  EXPECT_THAT(error_of(v2 + "$Bezel\n{\"bezel\":1\n$EndBezel\n"),
              HasSubstr("x.msh:17: bezel metadata: "));
  EXPECT_EQ(error_of(v2 + "$Bezel\n{\"bezel\":2}\n$EndBezel\n"),
            "x.msh:17: bezel metadata: version is 2, expected 1 to 1");
}

}  // namespace
}  // namespace bezel
