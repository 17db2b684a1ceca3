// VTU files that others may write, and every documented error by message.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cstdint>

#include "bezel/base/error.hpp"
#include "bezel/io/vtu.hpp"
#include "bezel/io/vtu_data.hpp"
#include "tests/unit/io/datasets.hpp"

namespace bezel {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string error_of(const std::string& bytes) {
  try {
    files::read_vtu("x.vtu", bytes);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string with(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  if (at == std::string::npos) throw std::logic_error("nothing to replace: " + what);
  return text.replace(at, what.size(), by);
}

const std::string square =
    "<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n"
    "<Piece NumberOfPoints=\"4\" NumberOfCells=\"2\">\n"
    "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\">0 0 0 1 0 0 1 1 0 0 1 0"
    "</DataArray></Points>\n<Cells>\n"
    "<DataArray type=\"Int32\" Name=\"connectivity\">0 1 2 0 2 3</DataArray>\n"
    "<DataArray type=\"Int32\" Name=\"offsets\">3 6</DataArray>\n"
    "<DataArray type=\"UInt8\" Name=\"types\">5 5</DataArray>\n</Cells>\n"
    "<PointData><DataArray type=\"Float64\" Name=\"u\">1 2 3 4</DataArray></PointData>\n"
    "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";

TEST(VtuRead, TextArrays) {
  const Dataset data = files::read_vtu("x.vtu", square);
  EXPECT_EQ(data.mesh->degree(), 1);
  EXPECT_EQ(data.mesh->element_count(), 2U);
  EXPECT_EQ(data.mesh->edge_count(), 5U);
  EXPECT_EQ(data.field("u").space().continuity(), Continuity::continuous);
  EXPECT_EQ(std::vector<double>(data.field("u").coefficients().begin(),
                                data.field("u").coefficients().end()),
            (std::vector<double>{1, 2, 3, 1, 3, 4}));
}

TEST(VtuRead, PointsOfTheirOwnAreMergedWhereTheyCoincide) {
  std::string apart =
      with(square, "0 0 0 1 0 0 1 1 0 0 1 0", "0 0 0 1 0 0 1 1 0 0 -0 0 1 1 0 0 1 0");
  apart = with(with(apart, "NumberOfPoints=\"4\"", "NumberOfPoints=\"6\""), "0 1 2 0 2 3",
               "0 1 2 3 4 5");
  const Dataset same = files::read_vtu("x.vtu", with(apart, ">1 2 3 4<", ">1 2 3 1 3 4<"));
  EXPECT_EQ(same.mesh->edge_count(), 5U);
  EXPECT_EQ(same.field("u").space().continuity(), Continuity::continuous);
  const Dataset jumps = files::read_vtu("x.vtu", with(apart, ">1 2 3 4<", ">1 2 3 5 3 4<"));
  EXPECT_EQ(jumps.mesh->edge_count(), 5U);
  EXPECT_EQ(jumps.field("u").space().continuity(), Continuity::discontinuous);
}

TEST(VtuRead, SharedPointsAreNotMerged) {
  // Two more triangles beside the square touch it at coinciding points: a slit.
  std::string slit =
      with(square, "0 0 0 1 0 0 1 1 0 0 1 0", "0 0 0 1 0 0 1 1 0 0 1 0 1 0 0 2 0 0 1 1 0");
  slit = with(with(slit, "NumberOfPoints=\"4\"", "NumberOfPoints=\"7\""), "0 1 2 0 2 3",
              "0 1 2 0 2 3 4 5 6");
  slit = with(with(with(slit, "3 6<", "3 6 9<"), "5 5<", "5 5 5<"), "NumberOfCells=\"2\"",
              "NumberOfCells=\"3\"");
  slit = with(slit, "1 2 3 4", "1 2 3 4 5 6 7");
  EXPECT_EQ(files::read_vtu("x.vtu", slit).mesh->edge_count(), 8U);
}

TEST(VtuRead, RawAppendedDataInTheOtherByteOrder) {
  std::string raw("\0\0\0\x30", 4);
  for (const float x : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 1.F, 1.F, 0.F, 0.F, 1.F, 0.F}) {
    std::string bytes(reinterpret_cast<const char*>(&x), 4);
    raw.append(bytes.rbegin(), bytes.rend());
  }
  std::string file = with(square, "\">0 0 0 1 0 0 1 1 0 0 1 0</DataArray>",
                          "\" format=\"appended\" offset=\"0\"/>");
  file = with(with(file, "LittleEndian", "BigEndian"), "</UnstructuredGrid>",
              "</UnstructuredGrid><AppendedData encoding=\"raw\">_" + raw + "</AppendedData>");
  const Dataset data = files::read_vtu("x.vtu", file);
  EXPECT_EQ(data.mesh->control(NodeId(2)), (Vec2{1, 1}));
}

TEST(VtuRead, PiecesAreJoined) {
  const std::size_t start = square.find("<Piece"), end = square.find("</UnstructuredGrid>");
  const std::string piece = square.substr(start, end - start);
  const Dataset data = files::read_vtu("x.vtu", square.substr(0, end) + piece + square.substr(end));
  EXPECT_EQ(data.mesh->element_count(), 4U);
  EXPECT_EQ(data.field("u").coefficients().size(), 12U);
}

TEST(VtuRead, SaysWhatWasSkipped) {
  const Dataset data = files::read_vtu(
      "x.vtu", with(square, "<PointData>",
                    "<PointData><DataArray type=\"Int32\" Name=\"ids\">1 2 3 4</DataArray>"));
  EXPECT_THAT(data.notes, ElementsAre("array 'ids' of points holds integers and was skipped"));
}

TEST(VtuErrors, Structure) {
  EXPECT_EQ(error_of(""), "x.vtu:1: the XML cannot be read: no document element found");
  EXPECT_EQ(error_of("<a/>"), "x.vtu: expected a VTKFile element at the top");
  EXPECT_EQ(error_of(with(square, "type=\"UnstructuredGrid\"", "type=\"PolyData\"")),
            "x.vtu:1: a VTK file of type 'PolyData', expected 'UnstructuredGrid'");
  EXPECT_EQ(error_of(with(square, "LittleEndian", "Middle")),
            "x.vtu:1: byte order 'Middle', expected 'LittleEndian' or 'BigEndian'");
  EXPECT_EQ(error_of(with(square, "byte_order", "header_type=\"Int8\" byte_order")),
            "x.vtu:1: header type 'Int8', expected 'UInt32' or 'UInt64'");
  EXPECT_EQ(error_of(with(square, "byte_order", "compressor=\"vtkLZ4DataCompressor\" byte_order")),
            "x.vtu:1: compressor 'vtkLZ4DataCompressor' is not supported, expected "
            "'vtkZLibDataCompressor'");
  EXPECT_EQ(error_of(with(square, "NumberOfPoints=\"4\"", "NumberOfPoints=\"many\"")),
            "x.vtu:3: NumberOfPoints is 'many', expected a number");
  EXPECT_EQ(error_of(with(square, "<PointData>", "<PointData RationalWeights=\"w\">")),
            "x.vtu:10: rational Bezier cells are not supported, expected polynomial ones");
  EXPECT_EQ(error_of(with(square, "\"offsets\"", "\"oops\"")),
            "x.vtu:5: Cells has no array 'offsets', expected one");
}

TEST(VtuErrors, Arrays) {
  EXPECT_EQ(error_of(with(square, "NumberOfPoints=\"4\"", "NumberOfPoints=\"1000000000000\"")),
            "x.vtu:4: data array '': 12 values, expected 3000000000000 (1000000000000 points x 3 "
            "components)");
  EXPECT_EQ(error_of(with(square, "1 2 3 4", "1 2 x 4")),
            "x.vtu:10: data array 'u': expected a number, found 'x'");
  EXPECT_EQ(error_of(with(square, "1 2 3 4", "1 2 nan 4")),
            "x.vtu:10: point 2: field 'u' is nan, expected a finite number");
  EXPECT_EQ(error_of(with(square, "1 2 3 4", "1 2 3")),
            "x.vtu:10: data array 'u': 3 values, expected 4 (4 points x 1 components)");
  EXPECT_EQ(error_of(with(square, "type=\"Float64\"", "type=\"Complex\"")),
            "x.vtu:10: data array 'u': type 'Complex' is not supported, expected Int8 to UInt64, "
            "Float32 or Float64");
  EXPECT_EQ(error_of(with(square, "Name=\"u\">1 2 3 4", "Name=\"u\" format=\"binary\">gAAAAA==")),
            "x.vtu:10: data array 'u': its header announces 128 bytes, at most 9 are there");
  EXPECT_EQ(
      error_of(with(square, "Name=\"u\">1 2 3 4", "Name=\"u\" format=\"appended\" offset=\"7\">")),
      "x.vtu:10: data array 'u': the file has no AppendedData (cut short)");
}

TEST(VtuErrors, Cells) {
  EXPECT_EQ(
      error_of(with(square, "5 5<", "5 9<")),
      "x.vtu: cell 1: type 9 (quadrilateral) is not supported, expected triangles (5, 22, 69, 76)");
  EXPECT_EQ(error_of(with(square, "5 5<", "5 22<")),
            "x.vtu: cell 1: type 22 (quadratic triangle) with 3 points, expected 6");
  EXPECT_EQ(error_of(with(with(square, "3 6<", "3 7<"), "0 2 3", "0 2 3 1")),
            "x.vtu: cell 1: type 5 (triangle) with 4 points, expected 3");
  EXPECT_EQ(
      error_of(with(with(with(square, "3 6<", "3 9<"), "0 2 3", "0 2 3 1 1 1"), "5 5<", "5 69<")),
      "x.vtu: cell 1: degree 2, the triangles before have degree 1; expected one degree");
  EXPECT_EQ(error_of(with(square, "0 2 3", "0 2 9")),
            "x.vtu: cell 1: point 9 does not exist, the piece has 4");
  EXPECT_EQ(error_of(with(square, "0 2 3", "0 2 2")),
            "x.vtu: cell 1: two of its corners are point 2, expected different points");
  EXPECT_EQ(error_of(with(square, "3 6<", "3 2<")),
            "x.vtu: cell 1: offset 2, expected 3 to 6 (the size of the connectivity)");
  EXPECT_EQ(error_of(with(square, "1 1 0 0 1 0", "1 1 0.5 0 1 0")),
            "x.vtu: point 2: z is 0.5, expected a planar mesh (z = 0 as at point 0)");
  EXPECT_EQ(error_of(with(square, "5 5<", "3 3<")), "x.vtu: the file has no triangles");
}

TEST(VtuErrors, TruncatedAppendedData) {
  Dataset data;
  data.mesh = io_test::disc(2);
  std::vector<std::string> lost;
  const std::string bytes = files::write_vtu(data, {}, lost);
  EXPECT_THAT(error_of(bytes.substr(0, bytes.size() - 40)),
              HasSubstr("AppendedData is not closed (file cut short)"));
}

TEST(Base64, IsThatOfRfc4648) {
  const std::vector<std::pair<std::string, std::string>> vectors{
      {"", ""}, {"f", "Zg=="}, {"fo", "Zm8="}, {"foo", "Zm9v"}, {"foobar", "Zm9vYmFy"}};
  for (const auto& [plain, coded] : vectors) {
    EXPECT_EQ(files::encode_base64(plain), coded);
    EXPECT_EQ(files::decode_base64(coded, 100), plain);
  }
  EXPECT_EQ(files::decode_base64(" Zg==\n Zm9v", 100), "ffoo");  // padded in the middle
  EXPECT_EQ(files::decode_base64("Zm9vYmFy", 4), "foob");
  EXPECT_EQ(files::decode_base64("Zm9v*mFy", 100), "foo");
}

TEST(ArrayBytes, RoundTripInEveryEncoding) {
  std::string bytes;
  for (int i = 0; i < 300000; ++i)
    bytes += static_cast<char>(static_cast<std::int64_t>(i) * i >> 7);
  for (const bool zlib : {false, true}) {
    const files::VtuEncoding encoding{true, false, zlib};
    for (const std::size_t n :
         {std::size_t{0}, std::size_t{1}, std::size_t{131072}, bytes.size()}) {
      const std::string part = bytes.substr(0, n);
      EXPECT_EQ(files::decode_array(files::encode_array(part, zlib), true, encoding), part);
    }
  }
}

TEST(ArrayBytes, ClaimsAreCheckedBeforeAllocating) {
  const auto error = [](const std::vector<std::uint64_t>& words) {
    std::string source(reinterpret_cast<const char*>(words.data()), words.size() * 8);
    try {
      files::decode_array(source, false, {true, false, true});
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(error({std::uint64_t{1} << 60, 1, 1, 1}),
            "its header announces 1152921504606846976 blocks, more than its 32 bytes can hold");
  EXPECT_EQ(error({1, std::uint64_t{1} << 50, 0, 8, 0}),
            "block 0 announces 1125899906842624 bytes, its 8 compressed bytes cannot hold them");
  EXPECT_EQ(error({1, 10, 0, 8, 0}), "block 0 cannot be decompressed (zlib status -3)");
}

}  // namespace
}  // namespace bezel
