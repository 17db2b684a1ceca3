// Reading VTU files: XML and data arrays; vtu_assemble.cpp makes a Dataset of them.

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <pugixml.hpp>

#include "bezel/io/cursor.hpp"
#include "bezel/io/vtu.hpp"
#include "bezel/io/vtu_content.hpp"
#include "bezel/io/vtu_data.hpp"
#include "bezel/io/xml.hpp"

namespace bezel::files {
namespace {

class VtuReader {
 public:
  VtuReader(const std::string& path, std::string_view bytes)
      : path_(path), bytes_(bytes), document_(path, bytes) {}

  VtuContent read() {
    parse();
    const pugi::xml_node root = document_.document().child("VTKFile");
    if (!root) fail(0, "expected a VTKFile element at the top");
    const std::string type = root.attribute("type").value();
    if (type != "UnstructuredGrid")
      fail(line(root),
           fmt::format("a VTK file of type '{}', expected 'UnstructuredGrid'", shown(type)));
    encoding(root);
    const pugi::xml_node grid = child(root, "UnstructuredGrid");
    field_data(grid.child("FieldData"));
    bool first = true;
    for (const pugi::xml_node& piece : grid.children("Piece")) {
      read_piece(piece, first);
      first = false;
    }
    if (first) fail(line(grid), "no Piece element, expected at least one");
    return std::move(content_);
  }

 private:
  [[noreturn]] void fail(std::int64_t at_line, const std::string& message) const {
    document_.fail(at_line, message);
  }
  std::int64_t line(const pugi::xml_node& node) const { return document_.line(node); }
  pugi::xml_node child(const pugi::xml_node& node, const char* name) const {
    return document_.child(node, name);
  }

  /// Raw appended data is no XML: it is cut out before the rest is parsed.
  void parse() {
    std::string xml;
    const std::size_t start = bytes_.find("<AppendedData");
    if (start == std::string_view::npos) {
      xml = bytes_;
    } else {
      const std::size_t close = bytes_.find('>', start);
      const std::size_t mark = close == std::string_view::npos ? close : bytes_.find('_', close);
      const std::int64_t at_line = line_of(bytes_, start);
      if (mark == std::string_view::npos)
        fail(at_line, "AppendedData holds no data after '_' (file cut short)");
      const std::size_t end = bytes_.rfind("</AppendedData");
      if (end == std::string_view::npos || end < mark)
        fail(at_line, "AppendedData is not closed (file cut short)");
      const std::string_view tag = bytes_.substr(start, close - start);
      appended_base64_ = tag.find("base64") != std::string_view::npos;
      if (!appended_base64_ && tag.find("raw") == std::string_view::npos)
        fail(at_line, "the encoding of AppendedData is unknown, expected raw or base64");
      appended_ = bytes_.substr(mark + 1, end - mark - 1);
      has_appended_ = true;
      xml = std::string(bytes_.substr(0, start)) + "</VTKFile>";
    }
    document_.parse(xml);
  }

  void encoding(const pugi::xml_node& root) {
    const std::string order = root.attribute("byte_order").as_string("LittleEndian");
    if (order != "LittleEndian" && order != "BigEndian")
      fail(line(root),
           fmt::format("byte order '{}', expected 'LittleEndian' or 'BigEndian'", shown(order)));
    encoding_.swap = (order == "LittleEndian") != (std::endian::native == std::endian::little);
    const std::string header = root.attribute("header_type").as_string("UInt32");
    if (header != "UInt32" && header != "UInt64")
      fail(line(root),
           fmt::format("header type '{}', expected 'UInt32' or 'UInt64'", shown(header)));
    encoding_.wide_header = header == "UInt64";
    const std::string compressor = root.attribute("compressor").value();
    if (!compressor.empty() && compressor != "vtkZLibDataCompressor")
      fail(line(root), fmt::format("compressor '{}' is not supported, expected "
                                   "'vtkZLibDataCompressor'",
                                   shown(compressor)));
    encoding_.zlib = !compressor.empty();
  }

  [[noreturn]] void fail_array(const pugi::xml_node& node, const std::string& message) const {
    fail(line(node),
         fmt::format("data array '{}': {}", shown(node.attribute("Name").value()), message));
  }

  /// The bytes of a binary array, numbers still in the file's byte order.
  std::string binary(const pugi::xml_node& node, bool appended) const {
    try {
      if (!appended) return decode_array(node.child_value(), true, encoding_);
      std::int64_t offset = 0;
      if (!parse_integer(node.attribute("offset").value(), offset) || offset < 0)
        throw InputError(fmt::format("offset '{}' is not a number of bytes",
                                     shown(node.attribute("offset").value())));
      if (!has_appended_) throw InputError("the file has no AppendedData (cut short)");
      if (static_cast<std::uint64_t>(offset) >= appended_.size())
        throw InputError(fmt::format("offset {} is beyond the {} bytes of appended data", offset,
                                     appended_.size()));
      return decode_array(appended_.substr(static_cast<std::size_t>(offset)), appended_base64_,
                          encoding_);
    } catch (const InputError& error) {
      fail_array(node, error.message());
    }
  }

  template <class Stored, class Value>
  void convert(const pugi::xml_node& node, std::string bytes, std::vector<Value>& out) const {
    if (bytes.size() % sizeof(Stored) != 0)
      fail_array(node, fmt::format("{} bytes of data, expected a multiple of {}", bytes.size(),
                                   sizeof(Stored)));
    if (encoding_.swap) swap_bytes(bytes, sizeof(Stored));
    out.resize(bytes.size() / sizeof(Stored));
    for (std::size_t i = 0; i < out.size(); ++i) {
      Stored stored;
      std::memcpy(&stored, bytes.data() + i * sizeof(Stored), sizeof(Stored));
      out[i] = static_cast<Value>(stored);  // NOLINT(bugprone-signed-char-misuse): Int8 is a number
    }
  }

  VtuArray array(const pugi::xml_node& node) const {
    VtuArray a;
    a.name = node.attribute("Name").value();
    a.line = line(node);
    std::int64_t components = 1;
    const char* const given = node.attribute("NumberOfComponents").as_string("1");
    if (!parse_integer(given, components) || components < 0 || components > 1000)
      fail_array(node, fmt::format("'{}' components, expected 1 to 1000", shown(given)));
    a.components = std::max(1, static_cast<int>(components));
    const std::string type = node.attribute("type").value();
    const std::string format = node.attribute("format").as_string("ascii");
    const bool real = type == "Float32" || type == "Float64";
    a.integer = !real;
    if (!real && type != "Int8" && type != "UInt8" && type != "Int16" && type != "UInt16" &&
        type != "Int32" && type != "UInt32" && type != "Int64" && type != "UInt64")
      fail_array(node,
                 fmt::format("type '{}' is not supported, expected Int8 to UInt64, Float32 or "
                             "Float64",
                             shown(type)));
    if (format == "ascii") {
      Cursor text(node.child_value(), path_);
      while (!text.at_end()) {
        const std::string_view word = text.word("");
        double r = 0.0;
        std::int64_t i = 0;
        if (!(real ? parse_real(word, r) : parse_integer(word, i)))
          fail_array(node, fmt::format("expected {}, found '{}'", real ? "a number" : "an integer",
                                       shown(word)));
        real ? a.reals.push_back(r) : a.integers.push_back(i);
      }
      return a;
    }
    if (format != "binary" && format != "appended")
      fail_array(node, fmt::format("format '{}', expected 'ascii', 'binary' or 'appended'",
                                   shown(format)));
    std::string bytes = binary(node, format == "appended");
    if (type == "Float64")
      convert<double>(node, std::move(bytes), a.reals);
    else if (type == "Float32")
      convert<float>(node, std::move(bytes), a.reals);
    else if (type == "Int8")
      convert<std::int8_t>(node, std::move(bytes), a.integers);
    else if (type == "UInt8")
      convert<std::uint8_t>(node, std::move(bytes), a.integers);
    else if (type == "Int16")
      convert<std::int16_t>(node, std::move(bytes), a.integers);
    else if (type == "UInt16")
      convert<std::uint16_t>(node, std::move(bytes), a.integers);
    else if (type == "Int32")
      convert<std::int32_t>(node, std::move(bytes), a.integers);
    else if (type == "UInt32")
      convert<std::uint32_t>(node, std::move(bytes), a.integers);
    else if (type == "Int64")
      convert<std::int64_t>(node, std::move(bytes), a.integers);
    else if (type == "UInt64")
      convert<std::uint64_t>(node, std::move(bytes), a.integers);
    return a;
  }

  void field_data(const pugi::xml_node& data) {
    for (const pugi::xml_node& node : data.children()) {
      const std::string name = node.attribute("Name").value();
      if (name == "TimeValue" && std::string(node.name()) == "DataArray") {
        const VtuArray a = array(node);
        if (a.size() != 1) fail_array(node, fmt::format("{} values, expected 1", a.size()));
        content_.time = a.integer ? static_cast<double>(a.integers[0]) : a.reals[0];
        if (!std::isfinite(*content_.time))
          fail_array(node, fmt::format("the time is {}, expected a finite number", *content_.time));
      } else if (name == "bezel:metadata") {
        std::string text = string(node);
        text.resize(std::min(text.size(), text.find('\0')));
        try {
          content_.metadata = metadata_from_json(text);
        } catch (const InputError& error) {
          fail(line(node), error.message());
        }
      }
    }
  }

  std::string string(const pugi::xml_node& node) const {
    const std::string format = node.attribute("format").as_string("ascii");
    if (format != "ascii") return binary(node, format == "appended");
    std::string out;
    Cursor text(node.child_value(), path_);
    while (!text.at_end()) {  // character codes
      std::int64_t code = 0;
      const std::string_view word = text.word("");
      if (!parse_integer(word, code) || code < 0 || code > 255)
        fail_array(node, fmt::format("expected a character code, found '{}'", shown(word)));
      out += static_cast<char>(code);
    }
    return out;
  }

  std::size_t count(const pugi::xml_node& piece, const char* name) const {
    std::int64_t value = 0;
    const char* const given = piece.attribute(name).value();
    if (!parse_integer(given, value) || value < 0)
      fail(line(piece), fmt::format("{} is '{}', expected a number", name, shown(given)));
    return static_cast<std::size_t>(value);
  }

  VtuArray sized(const pugi::xml_node& node, std::size_t tuples, const char* what) const {
    VtuArray a = array(node);
    const auto width = static_cast<std::size_t>(a.components);
    if (a.size() % width != 0 || a.size() / width != tuples)
      fail_array(node, fmt::format("{} values, expected {} ({} {} x {} components)", a.size(),
                                   tuples * width, tuples, what, width));
    return a;
  }

  VtuArray cell_array(const pugi::xml_node& cells, const char* name) const {
    for (const pugi::xml_node& node : cells.children("DataArray"))
      if (std::string(node.attribute("Name").value()) == name) {
        VtuArray a = array(node);
        if (!a.integer) fail_array(node, "real numbers, expected integers");
        return a;
      }
    fail(line(cells), fmt::format("Cells has no array '{}', expected one", name));
  }

  void read_piece(const pugi::xml_node& piece, bool first) {
    const std::size_t points = count(piece, "NumberOfPoints");
    const std::size_t cells = count(piece, "NumberOfCells");
    const auto point_start = static_cast<std::int64_t>(content_.points.size() / 3);
    const auto cell_start = static_cast<std::int64_t>(content_.connectivity.size());
    {
      const pugi::xml_node node = child(child(piece, "Points"), "DataArray");
      const VtuArray a = sized(node, points, "points");
      if (a.components != 3 && points > 0)
        fail_array(node, fmt::format("{} coordinates per point, expected 3", a.components));
      for (std::size_t i = 0; i < a.size(); ++i) {
        const double x = a.integer ? static_cast<double>(a.integers[i]) : a.reals[i];
        if (!std::isfinite(x))
          fail_array(node, fmt::format("a coordinate of point {} is {}, expected a finite number",
                                       i / 3, x));
        content_.points.push_back(x);
      }
    }
    const pugi::xml_node cell_node = child(piece, "Cells");
    const VtuArray connectivity = cell_array(cell_node, "connectivity");
    const VtuArray offsets = cell_array(cell_node, "offsets");
    const VtuArray types = cell_array(cell_node, "types");
    if (offsets.size() != cells || types.size() != cells)
      fail(line(cell_node), fmt::format("{} offsets and {} types, expected {} (NumberOfCells)",
                                        offsets.size(), types.size(), cells));
    std::int64_t last = 0;
    for (std::size_t c = 0; c < cells; ++c) {
      const std::int64_t end = offsets.integers[c];
      if (end < last || end > static_cast<std::int64_t>(connectivity.size()))
        fail_cell(content_.types.size() + c,
                  fmt::format("offset {}, expected {} to {} (the size of the connectivity)", end,
                              last, connectivity.size()));
      for (std::int64_t i = last; i < end; ++i) {
        const std::int64_t p = connectivity.integers[static_cast<std::size_t>(i)];
        if (p < 0 || p >= static_cast<std::int64_t>(points))
          fail_cell(content_.types.size() + c,
                    fmt::format("point {} does not exist, the piece has {}", p, points));
        content_.connectivity.push_back(point_start + p);
      }
      last = end;
      content_.offsets.push_back(cell_start + end);
    }
    content_.types.insert(content_.types.end(), types.integers.begin(), types.integers.end());
    attributes(piece.child("PointData"), points, first, content_.point_data, "points");
    attributes(piece.child("CellData"), cells, first, content_.cell_data, "cells");
  }

  [[noreturn]] void fail_cell(std::size_t cell, const std::string& message) const {
    InputPlace place;
    place.file = path_;
    place.element_kind = "cell";
    place.element = static_cast<std::int64_t>(cell);
    throw InputError(place, message);
  }

  /// Point or cell data; every piece must have the arrays of the first.
  void attributes(const pugi::xml_node& data, std::size_t tuples, bool first,
                  std::vector<VtuArray>& out, const char* what) {
    if (data.attribute("RationalWeights"))
      fail(line(data), "rational Bezier cells are not supported, expected polynomial ones");
    const std::string degrees = data.attribute("HigherOrderDegrees").value();
    std::size_t found = 0;
    for (const pugi::xml_node& node : data.children()) {
      const std::string name = node.attribute("Name").value();
      if (std::string(node.name()) != "DataArray") {
        content_.notes.push_back(fmt::format(
            "array '{}' of {} does not hold numbers and was skipped", shown(name), what));
        continue;
      }
      if (!degrees.empty() && name == degrees) continue;  // the number of nodes says it, too
      if (name.empty()) fail(line(node), fmt::format("a data array of {} has no name", what));
      VtuArray a = sized(node, tuples, what);
      if (first) {
        for (const VtuArray& other : out)
          if (other.name == name) fail_array(node, "a second array of this name");
        out.push_back(std::move(a));
        ++found;
        continue;
      }
      for (VtuArray& known : out)
        if (known.name == name) {
          if (known.components != a.components || known.integer != a.integer)
            fail_array(node, "its type or components differ from those in the first piece");
          known.reals.insert(known.reals.end(), a.reals.begin(), a.reals.end());
          known.integers.insert(known.integers.end(), a.integers.begin(), a.integers.end());
          ++found;
        }
    }
    if (found != out.size())
      fail(line(data), fmt::format("a piece has {} of the {} arrays of {} of the first", found,
                                   out.size(), what));
  }

  std::string path_;
  std::string_view bytes_;
  Xml document_;
  std::string_view appended_;
  bool has_appended_ = false, appended_base64_ = false;
  VtuEncoding encoding_;
  VtuContent content_;
};

}  // namespace

Dataset read_vtu(const std::string& path, std::string_view bytes) {
  return assemble_vtu(path, VtuReader(path, bytes).read());
}

}  // namespace bezel::files
