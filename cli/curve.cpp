// bezel curve: the polynomial curve that interpolates a given curve best.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bezel/base/atomic_file.hpp"
#include "bezel/base/error.hpp"
#include "bezel/fit/curve_interpolation.hpp"
#include "bezel/fit/lobatto.hpp"
#include "bezel/view/canvas.hpp"
#include "cli/curve_picture.hpp"
#include "cli/curve_spec.hpp"
#include "cli/json_text.hpp"
#include "cli/polynomial_options.hpp"
#include "cli/text_table.hpp"

namespace bezel::cli {
namespace {

struct CurveCommand {
  std::string file, x, y, z, from, to, breaks, shape, method = "best", out;
  int degree = 5, max_pieces = 1000;
  std::optional<double> tolerance;
  bool pieces = false, hex = false;
  CurveDrawOptions draw{800, false};
};

constexpr std::array<std::pair<const char*, CurveMethod>, 8> method_words = {
    {{"standard", CurveMethod::standard},
     {"chord", CurveMethod::chord},
     {"arclength", CurveMethod::arc_length},
     {"arc-length", CurveMethod::arc_length},
     {"l2", CurveMethod::l2},
     {"equal-tangent", CurveMethod::equal_tangent},
     {"orthogonal-distance", CurveMethod::orthogonal_distance},
     {"best", CurveMethod::best}}};

CurveMethod method_of(const std::string& word) {
  return std::find_if(method_words.begin(), method_words.end(),
                      [&](const auto& m) { return word == m.first; })
      ->second;
}

CurveSpecs read_input(const CurveCommand& o, const Context& context) {
  const bool formulas = !o.x.empty() || !o.y.empty() || !o.z.empty();
  const int given = int(!o.file.empty()) + int(formulas) + int(!o.shape.empty());
  if (given != 1)
    throw UsageError(given == 0 ? "FILE, --x and --y, or --shape is required"
                                : "FILE, --x and --y, and --shape exclude each other");
  if (!formulas && !(o.from.empty() && o.to.empty() && o.breaks.empty()))
    throw UsageError("--from, --to and --breaks need --x and --y");
  CurveSpecs specs;
  if (!o.file.empty()) {
    const InputText text = read_input_text(o.file);
    specs = read_curve_specs(text.name, text.text);
    if (specs.rounded > 0)
      note(context, fmt::format("{}: {} rounded to the nearest double", text.name,
                                counted(specs.rounded, "rational number")));
    return specs;
  }
  CurveSpec spec;
  if (formulas) {
    if (o.x.empty() || o.y.empty()) throw UsageError("--x and --y are both required");
    if (o.from.empty() || o.to.empty()) throw UsageError("--x and --y need --from and --to");
    std::vector<double> breaks;
    for (std::size_t start = 0; !o.breaks.empty() && start <= o.breaks.size();) {
      const auto comma = std::min(o.breaks.find(',', start), o.breaks.size());
      breaks.push_back(constant("--breaks", o.breaks.substr(start, comma - start)));
      start = comma + 1;
    }
    std::vector<std::pair<std::string, std::string>> components = {{"--x", o.x}, {"--y", o.y}};
    if (!o.z.empty()) components.emplace_back("--z", o.z);
    spec = formula_spec(components, constant("--from", o.from), constant("--to", o.to), breaks);
  } else {
    try {
      spec.plane = named_shape(o.shape);
    } catch (const InputError& error) {
      throw InputError(fmt::format("--shape: {}", error.what()));
    }
  }
  spec.name = spec.place = "curve 0";
  specs.curves.push_back(std::move(spec));
  return specs;
}

/// What stops a method, as one line.
std::string refusal(CurveStatus status, const std::string& method) {
  switch (status) {
    case CurveStatus::not_a_graph:
      return fmt::format(
          "not a graph: x is not strictly monotone along the curve, as --method {} needs it",
          method);
    case CurveStatus::not_a_chord_map:
      return "the projection onto the chord is not strictly monotone along the curve, as --method "
             "chord needs it";
    case CurveStatus::closed:
      return "the curve is closed: it has no chord, which --method chord needs";
    default:
      return {};
  }
}

template <int dim>
Json points_json(const std::vector<Vec<dim>>& points, bool hex) {
  Json out = Json::array();
  for (int c = 0; c < dim; ++c) {
    std::vector<double> column;
    for (const Vec<dim>& p : points) column.push_back(p[c]);
    out.push_back(numbers_json(column, hex));
  }
  return out;
}

/// Results of one curve: JSON, and text.
struct Report {
  Json json;
  std::string text;
  bool doubtful = false;  ///< no convergence, or the tolerance was not reached
};

template <int dim>
class Work {
 public:
  Work(const CurveCommand& options, const CurveInterpolator& interpolator)
      : o_(options), method_(method_of(options.method)), interpolator_(interpolator) {}

  std::vector<CurvePiece<dim>> pieces;

  Report run(const SmoothCurve<dim>& curve, const CurveSpec& spec) {
    Report out;
    const auto own = [&](double t) { return 0.5 * ((1.0 - t) * spec.from + (1.0 + t) * spec.to); };
    out.json = {{"degree", o_.degree}, {"method", o_.method}};
    if (o_.tolerance) {
      AdaptiveCurve<dim> found =
          interpolate_adaptive(curve, o_.degree, {*o_.tolerance, o_.max_pieces}, method_);
      pieces = std::move(found.pieces);
      out.json["tolerance"] = *o_.tolerance;
      out.json["reached"] = found.reached;
      out.doubtful = !found.reached;
    } else if (o_.pieces) {
      pieces = interpolate_pieces(curve, o_.degree, method_);
    } else {
      pieces = {{-1.0, 1.0, interpolator_.interpolate(curve, o_.degree, method_)}};
    }
    for (const CurvePiece<dim>& piece : pieces) {
      const CurveStatus status = piece.interpolant.nodes.status;
      const std::string why = refusal(status, o_.method);
      if (!why.empty()) throw InputError(why);
      out.doubtful = out.doubtful || status != CurveStatus::ok;
    }
    const bool in_pieces = o_.tolerance || o_.pieces;
    if (in_pieces) {
      double worst = 0.0;
      for (const CurvePiece<dim>& piece : pieces)
        worst = std::max(worst, piece.interpolant.errors.distance_max);
      out.json["dmax"] = number_json(worst, o_.hex);
      out.json["pieces"] = Json::array();
      out.text = fmt::format("{}: {}, largest distance {:.3g}\n", spec.name,
                             counted(pieces.size(), "piece"), worst);
    }
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      Json one = to_json(pieces[i], own);
      out.text +=
          to_text(pieces[i], own, in_pieces ? fmt::format("\npiece {}: ", i) : spec.name + ": ");
      if (in_pieces) {
        out.json["pieces"].push_back(std::move(one));
      } else {
        out.json.update(one);
      }
    }
    return out;
  }

 private:
  template <class Own>
  std::vector<double> parameters(const CurvePiece<dim>& piece, const Own& own) const {
    std::vector<double> out;
    for (const double t : piece.interpolant.nodes.t)
      out.push_back(own(0.5 * ((1.0 - t) * piece.t0 + (1.0 + t) * piece.t1)));
    return out;
  }

  template <class Own>
  Json to_json(const CurvePiece<dim>& piece, const Own& own) const {
    const CurveInterpolant<dim>& p = piece.interpolant;
    const CurveErrors& e = p.errors;
    const std::span<const double> xi = basis_.nodes();
    return {{"status", std::string(name(p.nodes.status))},
            {"kind", std::string(name(p.nodes.kind))},
            {"xi", numbers_json({xi.begin(), xi.end()}, o_.hex)},
            {"t", numbers_json(parameters(piece, own), o_.hex)},
            {"points", points_json(p.nodal, o_.hex)},
            {"control", points_json(p.control, o_.hex)},
            {"l2", e.l2 < 0.0 ? Json() : number_json(e.l2, o_.hex)},
            {"d2", number_json(e.distance_l2, o_.hex)},
            {"dmax", number_json(e.distance_max, o_.hex)},
            {"arc_length_error", number_json(e.arc_length, o_.hex)},
            {"min_speed", number_json(e.min_speed, o_.hex)},
            {"iterations", p.nodes.newton_iterations + p.nodes.distance_iterations},
            {"newton_iterations", p.nodes.newton_iterations},
            {"residual", number_json(p.nodes.residual, o_.hex)},
            {"monotone", e.monotone}};
  }

  template <class Own>
  std::string to_text(const CurvePiece<dim>& piece, const Own& own, const std::string& name) const {
    const CurveInterpolant<dim>& p = piece.interpolant;
    const CurveErrors& e = p.errors;
    std::string kind = p.nodes.kind == CurveKind::placed          ? o_.method
                       : p.nodes.kind == CurveKind::equal_tangent ? "equal tangents"
                                                                  : "least distance";
    if (p.nodes.status != CurveStatus::ok) kind += ", not converged";
    std::string out = fmt::format(
        "{}degree {}, {}\ndistance to the curve: L2 {:.3g}, largest {:.3g}; error of the length "
        "{:.3g}; smallest speed {:.3g}\n",
        name, p.degree(), kind, e.distance_l2, e.distance_max, e.arc_length, e.min_speed);
    std::vector<std::string> header = {"xi", "t", "x", "y"};
    if (dim == 3) header.emplace_back("z");
    std::vector<std::vector<std::string>> rows;
    const std::vector<double> t = parameters(piece, own);
    for (std::size_t i = 0; i < t.size(); ++i) {
      rows.push_back({exact_text(basis_.nodes()[i], o_.hex), exact_text(t[i], o_.hex)});
      for (int c = 0; c < dim; ++c) rows.back().push_back(exact_text(p.nodal[i][c], o_.hex));
    }
    return out + aligned(header, rows);
  }

  const CurveCommand& o_;
  CurveMethod method_;
  const CurveInterpolator& interpolator_;
  LobattoBasis basis_{o_.degree};
};

/// Pieces in space, for pictures.
std::vector<CurvePiece<2>> flattened(const std::vector<CurvePiece<3>>& pieces) {
  std::vector<CurvePiece<2>> out;
  const auto flat = [](const std::vector<Vec3>& points) {
    std::vector<Vec2> plane;
    for (const Vec3& p : points) plane.push_back(Vec2{{p[0], p[1]}});
    return plane;
  };
  for (const CurvePiece<3>& piece : pieces) {
    const CurveInterpolant<3>& p = piece.interpolant;
    out.push_back({piece.t0, piece.t1, {p.nodes, flat(p.nodal), flat(p.control), p.errors}});
  }
  return out;
}

int run(const CurveCommand& options, const Context& context) {
  const bool to_json_file = options.out.ends_with(".json");
  if (options.tolerance && !(*options.tolerance > 0.0 && std::isfinite(*options.tolerance)))
    throw UsageError("--tolerance: expected a finite number above 0");
  std::vector<std::string> files;
  if (!options.out.empty()) {
    if (!to_json_file) view::check_extension(options.out);
    require_writable(options.out);
    files = {options.out};
  }
  const CurveSpecs input = read_input(options, context);
  const CurveInterpolator interpolator(options.degree);
  Json results = Json::array();
  std::string text;
  CurvePicture picture;
  const bool drawn = !options.out.empty() && !to_json_file;
  bool doubtful = false;
  for (const CurveSpec& spec : input.curves) {
    Report report;
    try {
      if (spec.plane) {
        Work<2> work(options, interpolator);
        report = work.run(*spec.plane, spec);
        if (drawn) draw_interpolants(picture, spec.name, *spec.plane, work.pieces, !input.list);
      } else {
        Work<3> work(options, interpolator);
        report = work.run(*spec.space, spec);
        if (drawn)
          draw_interpolants(picture, spec.name, projected(*spec.space), flattened(work.pieces),
                            !input.list);
      }
    } catch (const InputError& error) {
      if (options.file.empty()) throw;
      throw InputError(InputPlace{options.file, 0, spec.name, -1}, error.message());
    }
    Json result = input.list ? Json{{"name", spec.name}} : Json::object();
    result.update(report.json);
    results.push_back(std::move(result));
    text += (text.empty() ? "" : "\n") + report.text;
    doubtful = doubtful || report.doubtful;
  }
  const std::string object = results_text("bezel/curve/1", input.list, results);
  if (to_json_file) {
    write_file(options.out, object);
  } else if (drawn) {
    picture.vertex_name = "node";
    draw_curves(options.out, picture, options.draw);
  }
  print_or_remove(context.json ? object : text, files);
  return doubtful ? check_failed : ok;
}

}  // namespace

void add_curve(CLI::App& app, Context& context) {
  auto options = std::make_shared<CurveCommand>();
  CurveCommand& o = *options;
  CLI::App* command =
      add_command(app, context, "curve",
                  "Interpolate a curve by a polynomial one of highest order; exit code 1 when it "
                  "did not converge or stayed above the tolerance",
                  "bezel curve --shape 'naca 0012 upper' --degree 6 -o upper.svg", options, run);
  command->add_option("FILE", o.file, "JSON file with a curve or a list; '-': the standard input");
  command->add_option("--x", o.x, "x as a formula in t")->type_name("EXPR");
  command->add_option("--y", o.y, "y as a formula in t")->type_name("EXPR");
  command->add_option("--z", o.z, "z as a formula in t: a curve in space")->type_name("EXPR");
  command->add_option("--from", o.from, "First value of t, such as 0 or -pi/2")->type_name("T");
  command->add_option("--to", o.to, "Last value of t")->type_name("T");
  command->add_option("--breaks", o.breaks, "Values of t where a derivative jumps")
      ->type_name("T,...");
  command
      ->add_option("--shape", o.shape,
                   "A named shape: 'circle radius=2 to=pi/2', 'ellipse a=2 b=1', 'naca 0012', "
                   "'superellipse n=4', 'clothoid k0=0 k1=4 length=1', 'polynomial x=0,1 y=0,0,1'")
      ->type_name("SHAPE");
  command->add_option("--degree", o.degree, "Degree of the interpolant, 1 to 30")
      ->check(CLI::Range(1, max_curve_degree))
      ->type_name("N")
      ->capture_default_str();
  std::vector<std::string> words;
  for (const auto& m : method_words) words.emplace_back(m.first);
  command->add_option("--method", o.method, "How the nodes are placed")
      ->check(CLI::IsMember(words))
      ->type_name("METHOD")
      ->capture_default_str();
  command->add_flag("--pieces", o.pieces, "One interpolant between every two breaks");
  command
      ->add_option("--tolerance", o.tolerance,
                   "As many pieces as the distance to the curve needs to stay below this")
      ->type_name("D");
  command->add_option("--max-pieces", o.max_pieces, "With --tolerance: at most so many")
      ->check(CLI::Range(1, 100000))
      ->type_name("N")
      ->capture_default_str();
  command->add_option("-o,--output", o.out, "Picture (.svg, .png) or result (.json) to write")
      ->type_name("FILE");
  command->add_option("--width", o.draw.width, "Width of the picture in pixels")
      ->check(CLI::Range(64, 16384))
      ->type_name("PIXELS")
      ->capture_default_str();
  command->add_flag("--control-polygons", o.draw.control_polygons, "Draw control polygons");
  command->add_flag("--hex", o.hex, "Print hex floats");
}

}  // namespace bezel::cli
