// The native form: its text, and every documented error by message.

#include <gtest/gtest.h>

#include <limits>

#include "bezel/base/error.hpp"
#include "bezel/io/cursor.hpp"
#include "bezel/io/native.hpp"
#include "tests/unit/io/datasets.hpp"

namespace bezel {
namespace {

std::string error_of(const std::string& bytes) {
  try {
    files::read_native("x.bzl", bytes);
  } catch (const InputError& error) {
    return error.in_file("x.bzl").what();
  }
  return "no error";
}

std::string with(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  if (at == std::string::npos) throw std::logic_error("nothing to replace: " + what);
  return text.replace(at, what.size(), by);
}

const std::string triangle =
    "bezel 1\nmesh triangle degree 1 nodes 3 elements 1\n"                 // 1-2
    "0x0p+0 0x0p+0\n0x1p+0 -0x0p+0\n0x1.5555555555555p-2 0x1p+0\n0 1 2\n"  // 3-6
    "groups 1\n2 3 \"a \\\"b\\\"\\n\"\nentities 1\n2 7 1 3\nelement_entities 1\n7\nedges 1\n5 "
    "0 1\n"                                                 // 7-14
    "points 1\n6 2\ntime 0x1.999999999999ap-4\nfields 1\n"  // 15-18
    "field \"u\" components 1 basis reference continuity continuous degree 1\n0x1p+0 0x0p+0 "
    "0x1p-1\n"
    "end\n";  // 19-21

TEST(Native, TheTextIsStable) {
  const Dataset data = files::read_native("x.bzl", triangle);
  EXPECT_EQ(files::write_native(data), triangle);
  EXPECT_EQ(data.mesh->tags().groups[0].name, "a \"b\"\n");
  EXPECT_EQ(data.time, 0.1);
  EXPECT_TRUE(std::signbit(data.mesh->control(NodeId(1)).y()));
}

TEST(Native, DecimalNumbersAreReadToo) {
  const Dataset data = files::read_native("x.bzl", with(triangle, "0x1p-1", "0.1"));
  EXPECT_EQ(data.fields[0].coefficients()[2], 0.1);
}

TEST(NativeErrors, EachIsNamedWithItsLine) {
  EXPECT_EQ(error_of(""), "x.bzl:1: the file ends where 'bezel' was expected");
  EXPECT_EQ(error_of(with(triangle, "bezel 1", "bezel 2")),
            "x.bzl:1: version 2 is not supported, expected 1");
  EXPECT_EQ(error_of(with(triangle, "degree 1", "degree 11")),
            "x.bzl:2: the geometric degree is 11, expected 1 to 10");
  EXPECT_EQ(error_of(with(triangle, "nodes 3", "nodes 1000000000000")),
            "x.bzl:2: the number of nodes is 1000000000000, more than the " +
                std::to_string(triangle.size() - triangle.find(" elements 1\n")) +
                " bytes left in the file can hold");
  EXPECT_EQ(error_of(with(triangle, "-0x0p+0", "inf")),
            "x.bzl:4: a coordinate is inf, expected a finite number");
  EXPECT_EQ(error_of(with(triangle, "-0x0p+0", "0xzp+0")),
            "x.bzl:4: expected a coordinate (a number), found '0xzp+0'");
  EXPECT_EQ(error_of(with(triangle, "0 1 2", "0 1 3")),
            "x.bzl:6: node 3 does not exist, the mesh has 3");
  EXPECT_EQ(error_of(with(triangle, "0 1 2", "0 1 1")),
            "x.bzl: triangle 0: corners 1 and 2 are both node 1, expected different nodes");
  EXPECT_EQ(error_of(with(triangle, "groups 1", "group 1")),
            "x.bzl:7: expected 'groups', found 'group'");
  EXPECT_EQ(error_of(with(triangle, "2 3 \"a", "2 3 a")),
            "x.bzl:8: expected a physical name in double quotes, found 'a'");
  EXPECT_EQ(error_of(with(triangle, "element_entities 1\n7", "element_entities 2\n7 7")),
            "x.bzl:11: 2 element entities, expected 0 or 1");
  EXPECT_EQ(error_of(with(triangle, "basis reference", "basis other")),
            "x.bzl:19: expected 'reference' or 'physical', found 'other'");
  EXPECT_EQ(error_of(with(triangle, "basis reference", "basis physical")),
            "x.bzl:19: a continuous field in the physical basis, expected discontinuous");
  EXPECT_EQ(error_of(with(triangle, "degree 1\n0x1p", "degree 0\n0x1p")),
            "x.bzl:19: a degree is 0, expected 1 to 10");
  EXPECT_EQ(error_of(with(triangle, "components 1", "components 10")),
            "x.bzl:19: the number of components is 10, expected 1 to 9");
  EXPECT_EQ(error_of(with(triangle, " 0x1p-1\nend", "\nend")),
            "x.bzl:21: expected a coefficient (a number), found 'end'");
  EXPECT_EQ(error_of(with(triangle, "\nend\n", "\n")),
            "x.bzl:21: the file ends where 'end' was expected");
  EXPECT_EQ(error_of(triangle + "more"), "x.bzl:22: 'more' after the end of the data");
}

TEST(NativeErrors, AContinuousFieldMustAgreeBetweenNeighbours) {
  Dataset data;
  data.mesh = io_test::disc(1);
  data.fields = {io_test::wavy("u", Space::continuous(data.mesh, 2))};
  std::string bytes = files::write_native(data);
  EXPECT_EQ(error_of(bytes), "no error");
  const std::size_t last = bytes.rfind("\nend");
  const std::size_t row = bytes.rfind('\n', last - 1);
  bytes.replace(row + 1, last - row - 1, "0x1p+9 0x1p+9 0x1p+9 0x1p+9 0x1p+9 0x1p+9");
  EXPECT_EQ(
      error_of(bytes),
      "x.bzl: triangle " + std::to_string(data.mesh->element_count() - 1) +
          ": the continuous field 'u' differs from a neighbour's coefficient, expected the same");
}

TEST(Numbers, HexAndDecimalReadBackExactly) {
  for (const double x : {0.0, -0.0, 1.0 / 3.0, -1e300, std::numeric_limits<double>::denorm_min(),
                         std::numeric_limits<double>::max(), 0.1}) {
    std::string hex, decimal;
    files::append_hex(hex, x);
    files::append_number(decimal, x);
    double a = 7, b = 7;
    ASSERT_TRUE(files::parse_real(hex, a)) << hex;
    ASSERT_TRUE(files::parse_real(decimal, b)) << decimal;
    EXPECT_EQ(std::signbit(a), std::signbit(x));
    EXPECT_EQ(a, x);
    EXPECT_EQ(b, x);
  }
  double value = 0.0;
  EXPECT_TRUE(files::parse_real("+1.5e2", value));
  EXPECT_EQ(value, 150.0);
  EXPECT_TRUE(files::parse_real("1e-400", value));
  EXPECT_EQ(value, 0.0);
  for (const char* const bad : {"", "-", "+-1", "--1", "0x", "0x-1", "1.5x", "1 ", "e5"})
    EXPECT_FALSE(files::parse_real(bad, value)) << bad;
}

}  // namespace
}  // namespace bezel
