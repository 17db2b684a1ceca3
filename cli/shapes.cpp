#include "cli/shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/index.hpp"
#include "bezel/io/cursor.hpp"
#include "cli/json_fields.hpp"
#include "cli/polynomials.hpp"

namespace bezel::cli {
namespace {

using Kind = JsonValue::Kind;

class ShapeReader : private JsonFields {
 public:
  ShapeReader(const std::string& file, const JsonValue& root) : JsonFields(file), root_(root) {}

  Shapes read() {
    read_root();
    out_.rounded = rounded();
    return std::move(out_);
  }

 private:
  void read_root() {
    if (root_.kind != Kind::object)
      fail(root_, "", fmt::format("found {}, expected an object", described(root_)));
    if (root_.find("a") || root_.find("b")) {  // one pair
      read_pair(root_, "");
      return;
    }
    check_keys(root_, "", {"curves", "triangles", "pairs", "a", "b"});
    if (root_.items.size() != 1)
      fail(root_, "",
           fmt::format("found {} of the keys \"curves\", \"triangles\" and \"pairs\", expected one",
                       root_.items.size()));
    const JsonValue& list = root_.items[0];
    const std::string& key = root_.keys[0];
    if (list.kind != Kind::array)
      fail(list, key, fmt::format("found {}, expected an array", described(list)));
    if (key == "pairs") {
      read_pairs(list);
    } else {
      read_list(list, key == "triangles");
    }
  }

  void read_list(const JsonValue& list, bool triangle) {
    const std::size_t n = list.items.size(), least = triangle ? 2 : 1;
    if (n < least || n > most_shapes)
      fail(list, root_.keys[0], fmt::format("found {}, expected {} to {}", n, least, most_shapes));
    for (std::size_t i = 0; i < n; ++i) {
      const JsonValue& item = list.items[i];
      const std::string where = fmt::format("{} {}", triangle ? "triangle" : "curve", i);
      check_object(item, where);
      check_keys(item, where, {"control", "degree", "name"});
      Shape shape;
      shape.triangle = triangle;
      shape.control = points(required(item, where, "control"), where);
      finish(shape, item, where);
    }
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 1; j < n; ++j) out_.pairs.emplace_back(i, j);
  }

  void read_pairs(const JsonValue& list) {
    if (list.items.empty()) fail(list, "pairs", "found 0, expected at least 1");
    for (std::size_t i = 0; i < list.items.size(); ++i) {
      const std::string where = fmt::format("pair {}", i);
      check_object(list.items[i], where);
      read_pair(list.items[i], where);
    }
  }

  void read_pair(const JsonValue& item, const std::string& where) {
    out_.in_pairs = true;
    check_keys(item, where, {"a", "b"});
    for (const char* key : {"a", "b"})
      read_member(required(item, where, key),
                  where.empty() ? std::string(key) : fmt::format("{}, {}", where, key));
    const std::size_t n = out_.shapes.size();
    if (out_.shapes[n - 2].triangle != out_.shapes[n - 1].triangle)
      fail(item, where, "found a curve and a triangle, expected two of a kind");
    out_.pairs.emplace_back(n - 2, n - 1);
  }

  void read_member(const JsonValue& item, const std::string& where) {
    check_object(item, where);
    check_keys(item, where, {"curve", "triangle", "degree", "name"});
    const JsonValue *curve = item.find("curve"), *triangle = item.find("triangle");
    if ((curve == nullptr) == (triangle == nullptr))
      fail(item, where, "expected one of the keys \"curve\" and \"triangle\"");
    Shape shape;
    shape.triangle = curve == nullptr;
    shape.control = plane_points(curve ? *curve : *triangle, where);
    finish(shape, item, where);
  }

  /// [[x, y], ...]
  std::vector<Vec2> points(const JsonValue& list, const std::string& where) {
    constexpr const char* form = "expected an array of points [x, y]";
    if (list.kind != Kind::array)
      fail(list, where, fmt::format("found {}, {}", described(list), form));
    std::vector<Vec2> out;
    for (std::size_t i = 0; i < list.items.size(); ++i) {
      const JsonValue& point = list.items[i];
      const std::string place = fmt::format("{}, point {}", where, i);
      if (point.kind != Kind::array)
        fail(point, place, fmt::format("found {}, expected [x, y]", described(point)));
      if (point.items.size() != 2)
        fail(point, place, fmt::format("found {} coordinates, expected 2", point.items.size()));
      out.push_back(
          Vec2{{number(point.items[0], place + ", x"), number(point.items[1], place + ", y")}});
    }
    return out;
  }

  /// [[x, ...], [y, ...]]
  std::vector<Vec2> plane_points(const JsonValue& lists, const std::string& where) {
    const std::vector<std::vector<double>> columns = coordinates(lists, where, 2, 2);
    std::vector<Vec2> out;
    for (std::size_t i = 0; i < columns[0].size(); ++i)
      out.push_back(Vec2{{columns[0][i], columns[1][i]}});
    return out;
  }

  /// Degree and name, and whether the number of control points is right.
  void finish(Shape& shape, const JsonValue& item, const std::string& where) {
    shape.line = item.line;
    shape.place = shape.name = where;
    const std::size_t n = shape.control.size();
    const int most =
        shape.triangle ? bernstein::max_triangle_degree : bernstein::max_interval_degree;
    const int least = shape.triangle ? 1 : 0;
    const auto size = [&](int degree) {
      return static_cast<std::size_t>(bernstein::simplex_size(shape.triangle ? 2 : 1, degree));
    };
    if (const JsonValue* degree = item.find("degree")) {
      shape.degree = whole(*degree, where, "degree", least, most);
      if (n != size(shape.degree))
        fail(item, where,
             fmt::format("found {} control points, expected {} for degree {}", n,
                         size(shape.degree), shape.degree));
    } else {
      shape.degree = least;
      while (shape.degree < most && size(shape.degree) < n) ++shape.degree;
      if (n != size(shape.degree))
        fail(item, where,
             shape.triangle
                 ? fmt::format("found {} control points, expected 3, 6, 10, 15, ..., {} (degree {} "
                               "to {})",
                               n, size(most), least, most)
                 : fmt::format("found {} control points, expected {} to {} (degree {} to {})", n,
                               size(least), size(most), least, most));
    }
    if (shape.triangle) check_extent(shape.control, item, where);
    if (const JsonValue* name = item.find("name")) {
      const std::string& text = string(*name, where, "name");
      if (!text.empty()) shape.name = files::shown(text);
    }
    out_.shapes.push_back(std::move(shape));
  }

  /// What the library asks of triangles: products of differences must neither overflow nor vanish.
  void check_extent(const std::vector<Vec2>& control, const JsonValue& item,
                    const std::string& where) const {
    Box2 box;
    double largest = 0.0;
    for (const Vec2& p : control) {
      box.include(p);
      largest = std::max({largest, std::fabs(p.x()), std::fabs(p.y())});
    }
    if (largest > 0x1p480)
      fail(item, where,
           fmt::format("found a coordinate of size {:.3g}, expected at most 2^480 = "
                       "3.12e144",
                       largest));
    const double extent = std::max(box.hi.x() - box.lo.x(), box.hi.y() - box.lo.y());
    if (extent > 0.0 && extent < 0x1p-480)
      fail(item, where,
           fmt::format("found an extent of {:.3g}, expected 0 or at least 2^-480 = "
                       "3.20e-145",
                       extent));
  }

  const JsonValue& root_;
  Shapes out_;
};

}  // namespace

Shapes read_shapes(const std::string& file, std::string_view json) {
  const JsonValue root = read_json(file, json);
  return ShapeReader(file, root).read();
}

}  // namespace bezel::cli
