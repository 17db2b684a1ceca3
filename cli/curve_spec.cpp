#include "cli/curve_spec.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bezel/base/error.hpp"
#include "bezel/fit/curve_sources.hpp"
#include "bezel/formula/formula.hpp"
#include "bezel/io/cursor.hpp"
#include "cli/json_fields.hpp"

namespace bezel::cli {
namespace {

using Kind = JsonValue::Kind;

constexpr std::size_t most_curves = 1000;

template <int dim>
std::vector<Vec<dim>> points_of(const std::vector<std::vector<double>>& columns) {
  std::vector<Vec<dim>> out(columns[0].size());
  for (std::size_t i = 0; i < out.size(); ++i)
    for (int c = 0; c < dim; ++c) out[i][c] = columns[static_cast<std::size_t>(c)][i];
  return out;
}

Formula parse(const std::string& what, const std::string& text) {
  try {
    return Formula(text, {"t"});
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", what, error.what()));
  }
}

class Reader : private JsonFields {
 public:
  using JsonFields::JsonFields;

  CurveSpecs read(const JsonValue& root) {
    CurveSpecs out;
    const JsonValue* list = &root;
    if (root.kind == Kind::object && root.find("curves")) {
      check_keys(root, "", {"curves"});
      list = root.find("curves");
      if (list->kind != Kind::array)
        fail(*list, "curves", fmt::format("found {}, expected an array", described(*list)));
    }
    if (list->kind == Kind::array) {
      out.list = true;
      if (list->items.empty() || list->items.size() > most_curves)
        fail(*list, "",
             fmt::format("found {} curves, expected 1 to {}", list->items.size(), most_curves));
      for (std::size_t i = 0; i < list->items.size(); ++i)
        out.curves.push_back(curve(list->items[i], fmt::format("curve {}", i)));
    } else {
      out.curves.push_back(curve(*list, "curve 0"));
    }
    out.rounded = rounded();
    return out;
  }

 private:
  CurveSpec curve(const JsonValue& item, const std::string& where) {
    check_object(item, where);
    check_keys(item, where,
               {"formula", "shape", "bezier", "bspline", "nurbs", "points", "name", "reverse",
                "scale", "rotate", "translate"});
    std::size_t kinds = 0;
    for (const char* key : {"formula", "shape", "bezier", "bspline", "nurbs", "points"})
      if (item.find(key)) ++kinds;
    if (kinds != 1)
      fail(item, where,
           fmt::format("found {} of the keys \"formula\", \"shape\", \"bezier\", \"bspline\", "
                       "\"nurbs\" and \"points\", expected one",
                       kinds));
    CurveSpec spec;
    try {
      spec = source(item, where);
      move(spec, item, where);
    } catch (const InputError& error) {
      if (!error.place().file.empty()) throw;
      fail(item, where, error.what());
    }
    spec.name = spec.place = where;
    if (const JsonValue* name = item.find("name")) {
      const std::string& text = string(*name, where, "name");
      if (!text.empty()) spec.name = files::shown(text);
    }
    return spec;
  }

  CurveSpec source(const JsonValue& item, const std::string& where) {
    if (const JsonValue* formula = item.find("formula")) return from_formula(*formula, where);
    if (const JsonValue* points = item.find("points")) return through_points(*points, where);
    if (const JsonValue* shape = item.find("shape")) {
      CurveSpec spec;
      spec.plane = named_shape(string(*shape, where, "shape"));
      return spec;
    }
    const JsonValue* bezier = item.find("bezier");
    const JsonValue* bspline = item.find("bspline");
    return bezier    ? from_control(*bezier, where, false, false)
           : bspline ? from_control(*bspline, where, true, false)
                     : from_control(*item.find("nurbs"), where, true, true);
  }

  CurveSpec from_formula(const JsonValue& value, const std::string& where) {
    check_object(value, where);
    check_keys(value, where, {"x", "y", "z", "from", "to", "breaks"});
    std::vector<std::pair<std::string, std::string>> components;
    for (const char* key : {"x", "y", "z"}) {
      const JsonValue* text = value.find(key);
      if (text) components.emplace_back(key, string(*text, where, key));
      if (!text && key[0] != 'z') (void)required(value, where, key);
    }
    std::vector<double> breaks;
    if (const JsonValue* list = value.find("breaks")) breaks = numbers(*list, where + ", breaks");
    return formula_spec(components, parameter(value, where, "from"), parameter(value, where, "to"),
                        breaks);
  }

  /// A number or a text such as "2*pi".
  double parameter(const JsonValue& object, const std::string& where, const char* key) {
    const JsonValue& value = required(object, where, key);
    if (value.kind == Kind::string) return constant(key, value.text);
    return number(value, where + ", " + key);
  }

  CurveSpec from_control(const JsonValue& value, const std::string& where, bool knotted,
                         bool rational) {
    check_object(value, where);
    if (knotted && rational) {
      check_keys(value, where, {"degree", "knots", "control", "weights"});
      (void)required(value, where, "weights");
    } else if (knotted) {
      check_keys(value, where, {"degree", "knots", "control"});
    } else {
      check_keys(value, where, {"control", "weights"});
    }
    const auto columns = coordinates(required(value, where, "control"), where, 2, 3);
    std::vector<double> weights, knots;
    if (const JsonValue* list = value.find("weights"))
      weights = numbers(*list, where + ", weights");
    int degree = 0;
    if (knotted) {
      degree = whole(required(value, where, "degree"), where, "degree", 1, 30);
      knots = numbers(required(value, where, "knots"), where + ", knots");
    }
    CurveSpec spec;
    const auto build = [&]<int dim>(std::optional<SmoothCurve<dim>>& out) {
      const std::vector<Vec<dim>> control = points_of<dim>(columns);
      out = knotted ? nurbs_curve<dim>(degree, knots, control, weights)
                    : bezier_curve<dim>(control, weights);
    };
    if (columns.size() == 2) {
      build(spec.plane);
    } else {
      build(spec.space);
    }
    return spec;
  }

  CurveSpec through_points(const JsonValue& value, const std::string& where) {
    // Coordinates alone, or an object with options.
    const bool alone = value.kind != Kind::object;
    SplineEnds ends = SplineEnds::not_a_knot;
    double exponent = 1.0;
    if (!alone) {
      check_keys(value, where, {"coordinates", "ends", "parameter"});
      if (const JsonValue* word = value.find("ends"))
        ends = static_cast<SplineEnds>(
            choice(*word, where, "ends", {"not-a-knot", "natural", "closed"}));
      if (const JsonValue* word = value.find("parameter"))
        exponent = choice(*word, where, "parameter", {"chord", "centripetal"}) == 0 ? 1.0 : 0.5;
    }
    const auto columns =
        coordinates(alone ? value : required(value, where, "coordinates"), where, 2, 3);
    CurveSpec spec;
    if (columns.size() == 2) {
      spec.plane = spline_curve<2>(points_of<2>(columns), ends, exponent);
    } else {
      spec.space = spline_curve<3>(points_of<3>(columns), ends, exponent);
    }
    return spec;
  }

  std::size_t choice(const JsonValue& value, const std::string& where, const char* what,
                     std::initializer_list<const char*> words) const {
    const std::string& text = string(value, where, what);
    std::size_t k = 0;
    std::string listed;
    for (const char* word : words) {
      if (text == word) return k;
      listed += fmt::format("{}{}", k == 0 ? "" : k + 1 == words.size() ? " or " : ", ", word);
      ++k;
    }
    fail(value, where,
         fmt::format("{}: found '{}', expected {}", what, files::shown(text), listed));
  }

  void move(CurveSpec& spec, const JsonValue& item, const std::string& where) {
    if (const JsonValue* flag = item.find("reverse"); flag && boolean(*flag, where, "reverse")) {
      if (spec.plane) spec.plane = reversed(*spec.plane);
      if (spec.space) spec.space = reversed(*spec.space);
      if (item.find("formula")) std::swap(spec.from, spec.to);
    }
    const JsonValue *scale = item.find("scale"), *rotate = item.find("rotate"),
                    *translate = item.find("translate");
    if (!scale && !rotate && !translate) return;
    if (!spec.plane)
      fail(item, where, "\"scale\", \"rotate\" and \"translate\" apply to curves in the plane");
    Vec2 shift{};
    if (translate) {
      const std::vector<double> given = numbers(*translate, where + ", translate");
      if (given.size() != 2)
        fail(*translate, where,
             fmt::format("translate: found {} numbers, expected 2", given.size()));
      shift = Vec2{{given[0], given[1]}};
    }
    spec.plane = moved(*spec.plane, scale ? number(*scale, where + ", scale") : 1.0,
                       rotate ? parameter(item, where, "rotate") : 0.0, shift);
  }
};

}  // namespace

CurveSpecs read_curve_specs(const std::string& file, std::string_view json) {
  return Reader(file).read(read_json(file, json));
}

CurveSpec formula_spec(const std::vector<std::pair<std::string, std::string>>& components,
                       double from, double to, const std::vector<double>& breaks) {
  std::vector<Formula> formulas;
  for (const auto& [name, text] : components) formulas.push_back(parse(name, text));
  CurveSpec spec;
  spec.from = from;
  spec.to = to;
  try {
    if (formulas.size() == 2) {
      spec.plane = formula_curve<2>(formulas, from, to, breaks);
    } else {
      spec.space = formula_curve<3>(formulas, from, to, breaks);
    }
  } catch (const InputError& error) {
    // The library's t runs from -1 to 1.
    const std::string message = error.what();
    if (message.find("at t = ") == std::string::npos || (from == -1.0 && to == 1.0)) throw;
    throw InputError(
        fmt::format("{} (counted from -1 where t = {} to 1 where t = {})", message, from, to));
  }
  return spec;
}

}  // namespace bezel::cli
