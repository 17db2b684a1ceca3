// Shapes by name: "ellipse a=2 b=1 to=pi".

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bezel/base/error.hpp"
#include "bezel/fit/curve_shapes.hpp"
#include "bezel/fit/curve_sources.hpp"
#include "bezel/formula/formula.hpp"
#include "bezel/io/cursor.hpp"
#include "cli/curve_spec.hpp"

namespace bezel::cli {
namespace {

constexpr double turn = 2.0 * std::numbers::pi;

/// The words after a shape's name, taken one by one; what is left over is an error.
class Words {
 public:
  explicit Words(std::string_view text) {
    while (true) {
      const auto start = text.find_first_not_of(" \t\n");
      if (start == std::string_view::npos) break;
      text.remove_prefix(start);
      const auto end = std::min(text.find_first_of(" \t\n"), text.size());
      words_.emplace_back(text.substr(0, end));
      text.remove_prefix(end);
    }
  }

  /// The first word, or nothing.
  std::string name() {
    if (words_.empty()) return {};
    std::string first = words_.front();
    words_.erase(words_.begin());
    shape_ = files::shown(first);
    return first;
  }
  /// A word without '=' that is one of these; the first of them when there is none.
  std::size_t one_of(std::initializer_list<const char*> choices) {
    std::size_t found = 0, k = 0;
    for (const char* choice : choices) {
      const auto at = std::find(words_.begin(), words_.end(), choice);
      if (at != words_.end()) {
        found = k;
        words_.erase(at);
      }
      ++k;
    }
    return found;
  }
  std::string word(const char* what) {
    for (auto at = words_.begin(); at != words_.end(); ++at)
      if (at->find('=') == std::string::npos) {
        std::string out = *at;
        words_.erase(at);
        return out;
      }
    throw InputError(fmt::format("{}: {} is missing", shape_, what));
  }
  std::optional<std::string> text(const std::string& key) {
    for (auto at = words_.begin(); at != words_.end(); ++at)
      if (at->starts_with(key + "=")) {
        std::string out = at->substr(key.size() + 1);
        words_.erase(at);
        return out;
      }
    return {};
  }
  double value(const std::string& key, double otherwise) {
    const auto given = text(key);
    return given ? constant(shape_ + ", " + key, *given) : otherwise;
  }
  double required(const std::string& key) {
    const auto given = text(key);
    if (!given) throw InputError(fmt::format("{}: {}=... is missing", shape_, key));
    return constant(shape_ + ", " + key, *given);
  }
  Vec2 point(const std::string& key) {
    const auto given = text(key);
    return given ? pair(key, *given) : Vec2{};
  }
  /// Numbers separated by commas.
  std::vector<double> list(const std::string& key) {
    const auto given = text(key);
    if (!given) throw InputError(fmt::format("{}: {}=... is missing", shape_, key));
    std::vector<double> out;
    for (std::size_t start = 0; start <= given->size();) {
      const auto comma = std::min(given->find(',', start), given->size());
      out.push_back(constant(shape_ + ", " + key, given->substr(start, comma - start)));
      start = comma + 1;
    }
    return out;
  }
  void done() const {
    if (!words_.empty())
      throw InputError(
          fmt::format("{}: '{}' is not understood", shape_, files::shown(words_.front())));
  }

 private:
  Vec2 pair(const std::string& key, const std::string& given) const {
    const auto comma = given.find(',');
    if (comma == std::string::npos)
      throw InputError(fmt::format("{}, {}: found '{}', expected two numbers such as 1,2", shape_,
                                   key, files::shown(given)));
    return Vec2{{constant(shape_ + ", " + key, given.substr(0, comma)),
                 constant(shape_ + ", " + key, given.substr(comma + 1))}};
  }

  std::string shape_;
  std::vector<std::string> words_;
};

SmoothCurve<2> read_aerofoil(Words& words) {
  const auto side = static_cast<AerofoilPart>(2 - words.one_of({"all", "lower", "upper"}));
  const auto edge =
      words.one_of({"sharp", "blunt"}) == 0 ? TrailingEdge::sharp : TrailingEdge::blunt;
  const double chord = words.value("chord", 1.0);
  const std::string digits = words.word("its number (0012)");
  words.done();
  return naca4(digits, side, edge, chord);
}

}  // namespace

double constant(const std::string& what, std::string_view text) {
  try {
    const double value = Formula(text, {})(std::span<const double>{});
    if (std::isfinite(value)) return value;
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", what, error.what()));
  }
  throw InputError(
      fmt::format("{}: '{}' is not finite, expected a number", what, files::shown(text)));
}

SmoothCurve<2> named_shape(std::string_view text) {
  Words words(text);
  const std::string name = words.name();
  if (name == "naca") return read_aerofoil(words);
  if (name == "circle" || name == "ellipse") {
    const bool circle = name == "circle";
    const Vec2 centre = words.point("center");
    const double a = circle ? words.value("radius", 1.0) : words.required("a");
    const double b = circle ? a : words.required("b");
    const double from = words.value("from", 0.0), to = words.value("to", turn);
    const double angle = circle ? 0.0 : words.value("angle", 0.0);
    words.done();
    return ellipse_arc(centre, a, b, from, to, angle);
  }
  if (name == "superellipse") {
    const double a = words.value("a", 1.0), b = words.value("b", 1.0), n = words.required("n");
    const double from = words.value("from", 0.0), to = words.value("to", turn);
    words.done();
    return superellipse_arc(a, b, n, from, to);
  }
  if (name == "clothoid") {
    const Vec2 start = words.point("start");
    const double heading = words.value("heading", 0.0), length = words.required("length");
    const double first = words.required("k0"), last = words.required("k1");
    words.done();
    return clothoid(start, heading, first, last, length);
  }
  if (name == "polynomial") {
    const std::vector<double> x = words.list("x"), y = words.list("y");
    const double from = words.value("from", 0.0), to = words.value("to", 1.0);
    words.done();
    std::vector<Vec2> coefficients(std::max(x.size(), y.size()));
    for (std::size_t i = 0; i < x.size(); ++i) coefficients[i][0] = x[i];
    for (std::size_t i = 0; i < y.size(); ++i) coefficients[i][1] = y[i];
    return polynomial_curve<2>(coefficients, from, to);
  }
  if (name == "line") {
    const Vec2 start = words.point("start"), end = words.point("end");
    words.done();
    return bezier_curve<2>(std::vector<Vec2>{start, end});
  }
  throw InputError(
      fmt::format("found the shape '{}', expected naca, circle, ellipse, superellipse, clothoid, "
                  "polynomial or line",
                  files::shown(name)));
}

}  // namespace bezel::cli
