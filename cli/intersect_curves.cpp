// What `intersect` says about curves.

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "bezel/geometry/self_intersection.hpp"
#include "cli/intersect_report.hpp"
#include "cli/polynomial_options.hpp"
#include "cli/text_table.hpp"

namespace bezel::cli {
namespace {

const std::vector<std::string> curve_columns = {"number", "what", "s",         "t",
                                                "x",      "y",    "condition", "remarks"};
constexpr const char* curve_units =
    "s, t: parameters of the first and second curve, 0 to 1; x, y: in the units of the input\n\n";

/// Lists, and rows of a table with numbers, as the picture has them.
class Writer {
 public:
  Writer(bool hex, int& next) : hex_(hex), next_(next) {}

  Json json(const CurveIntersections& found) const {
    Json out{{"crossings", Json::array()},
             {"tangencies", Json::array()},
             {"overlaps", Json::array()},
             {"unresolved", Json::array()}};
    for (const Crossing& c : found.crossings)
      out["crossings"].push_back({{"s", number(c.s)},
                                  {"t", number(c.t)},
                                  {"s_box", box(c.s_lo, c.s_hi)},
                                  {"t_box", box(c.t_lo, c.t_hi)},
                                  {"certified", c.certified},
                                  {"condition", number(c.condition)},
                                  {"sign", c.sign},
                                  {"point_a", point_json(c.point_a, hex_)},
                                  {"point_b", point_json(c.point_b, hex_)}});
    for (const Tangency& t : found.tangencies)
      out["tangencies"].push_back({{"s", number(t.s)},
                                   {"t", number(t.t)},
                                   {"order", t.order > 0 ? Json(t.order) : Json()},
                                   {"sign", t.sign}});
    for (const Overlap& o : found.overlaps)
      out["overlaps"].push_back({{"s", box(o.s0, o.s1)},
                                 {"t", box(o.t0, o.t1)},
                                 {"direction", direction(o)},
                                 {"gap", number(o.gap)}});
    for (const UnresolvedBox& u : found.unresolved)
      out["unresolved"].push_back(
          {{"s_box", box(u.s_lo, u.s_hi)}, {"t_box", box(u.t_lo, u.t_hi)}, {"reason", u.reason}});
    return out;
  }

  Json json(const Cusp& cusp) const {
    return {{"s", number(cusp.s)}, {"box", box(cusp.lo, cusp.hi)}, {"proven", cusp.proven}};
  }

  void add(const Curve& curve, const Cusp& cusp) {
    row("cusp", text(cusp.s), "", curve(cusp.s), "", cusp.proven ? "proven" : "not proven");
  }

  void add(const Curve& a, const CurveIntersections& found) {
    for (const Crossing& c : found.crossings)
      row("crossing", text(c.s), text(c.t), c.point_a, condition(c.condition),
          fmt::format("{}certified, sign {}", c.certified ? "" : "not ",
                      c.sign == 0 ? "unknown" : fmt::format("{:+d}", c.sign)));
    for (const Tangency& t : found.tangencies)
      row("tangency", text(t.s), text(t.t), a(t.s), "",
          t.order == 0  ? "order not proven"
          : t.sign == 0 ? fmt::format("order {}", t.order)
                        : fmt::format("order {}, sign {:+d}", t.order, t.sign));
    for (const Overlap& o : found.overlaps)
      row("overlap", interval(o.s0, o.s1), interval(o.t0, o.t1), {}, "",
          fmt::format("{} direction{}, gap {}", direction(o), o.t0 < o.t1 ? "" : "s",
                      condition(o.gap)));
    for (const UnresolvedBox& u : found.unresolved)
      row("unresolved", interval(u.s_lo, u.s_hi), interval(u.t_lo, u.t_hi), {}, "", u.reason);
  }

  std::string table() const {
    return rows_.empty() ? std::string() : aligned(curve_columns, rows_);
  }

 private:
  Json number(double x) const { return number_json(x, hex_); }
  Json box(double lo, double hi) const { return numbers_json({lo, hi}, hex_); }
  std::string text(double x) const { return exact_text(x, hex_); }
  std::string interval(double lo, double hi) const {
    return fmt::format("[{}, {}]", text(lo), text(hi));
  }
  static std::string condition(double x) { return fmt::format("{:.3g}", x); }
  static const char* direction(const Overlap& o) { return o.t0 < o.t1 ? "same" : "opposite"; }

  void row(const char* what, const std::string& s, const std::string& t,
           const std::optional<Vec2>& point, const std::string& condition,
           const std::string& remarks) {
    rows_.push_back({std::to_string(next_++), what, s, t, point ? text(point->x()) : "",
                     point ? text(point->y()) : "", condition, remarks});
  }

  bool hex_;
  int& next_;
  std::vector<std::vector<std::string>> rows_;
};

std::string counts(const CurveIntersections& found, std::size_t cusps) {
  return summary({{cusps, "cusp"},
                  {found.crossings.size(), "crossing"},
                  {found.tangencies.size(), "tangency"},
                  {found.overlaps.size(), "overlap"},
                  {found.unresolved.size(), "place unresolved"}},
                 "nothing in common");
}

void report_self(const Shape& shape, const ReportOptions& options, IntersectReport& out) {
  const SelfIntersections found = self_intersections(shape.control);
  int next = 1;
  Writer writer(options.hex, next);
  Json result{{"a", 0}, {"closed", found.closed}, {"cusps", Json::array()}};
  for (const Cusp& cusp : found.cusps) result["cusps"].push_back(writer.json(cusp));
  result.update(writer.json(found.pairs));
  out.results.push_back(std::move(result));
  const Curve curve(shape.control);
  for (const Cusp& cusp : found.cusps) writer.add(curve, cusp);
  writer.add(curve, found.pairs);
  const std::string table = writer.table();
  out.text = fmt::format("{}{} with itself: {}{}\n{}", table.empty() ? "" : curve_units, shape.name,
                         counts(found.pairs, found.cusps.size()),
                         found.closed ? "; it ends where it begins" : "", table);
  out.unresolved = found.pairs.unresolved.size();
  for (const Cusp& cusp : found.cusps) out.unresolved += cusp.proven ? 0 : 1;
  add_self_intersections(out.picture, shape.control, found);
}

}  // namespace

IntersectReport report_curves(const Shapes& input, const ReportOptions& options) {
  IntersectReport out;
  for (const Shape& shape : input.shapes)
    out.picture.shapes.push_back({shape.name, {shape.control}, false});
  if (input.pairs.empty()) {
    report_self(input.shapes[0], options, out);
    return out;
  }
  const IntersectOptions how{options.coincidence_distance};
  const auto found = meet_pairs<CurveIntersections>(
      input, options,
      [&](const Shape& a, const Shape& b) { return intersect(a.control, b.control, how); });
  int next = 1;
  bool any = false;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const auto& [first, second] = input.pairs[i];
    const std::vector<Vec2>& a = input.shapes[first].control;
    const int number = next;
    Writer writer(options.hex, next);
    Json result;
    if (!input.in_pairs) result.update({{"a", first}, {"b", second}});
    result.update(writer.json(found[i]));
    out.results.push_back(std::move(result));
    writer.add(Curve(a), found[i]);
    const std::string table = writer.table();
    any = any || !table.empty();
    out.text += fmt::format("{}{}: {}\n{}", i > 0 ? "\n" : "", pair_name(input, i),
                            counts(found[i], 0), table);
    out.unresolved += found[i].unresolved.size();
    add_intersections(out.picture, a, found[i], number);
  }
  if (any) out.text = curve_units + out.text;
  return out;
}

}  // namespace bezel::cli
