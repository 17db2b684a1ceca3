#include "bezel/view/svg_cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "bezel/bernstein/triangle.hpp"
#include "bezel/view/scalar.hpp"

namespace bezel::view {
namespace {

constexpr double first_tolerance = 0.006;  // of t: about 1.5 of 255 grey levels
constexpr double flat_range = 0.003;       // of t: less cannot be seen
constexpr double smallest = 2.0;           // pixels
constexpr int deepest = 6;
constexpr std::size_t most_cells = 20000;
constexpr int cell_lattice = 4;  // samples per side that judge a cell

class Cutter {
 public:
  Cutter(const FieldPaint& paint, double tolerance)
      : paint_(paint),
        tolerance_(tolerance),
        scalar_(*paint.field, paint.component),
        degree_(paint.field->mesh().degree()) {
    for (int k = 0; k <= cell_lattice; ++k)
      for (int j = 0; j <= cell_lattice - k; ++j)
        local_.push_back({static_cast<double>(cell_lattice - j - k) / cell_lattice,
                          static_cast<double>(j) / cell_lattice,
                          static_cast<double>(k) / cell_lattice});
    lambda_.resize(local_.size());
    pixel_.resize(local_.size());
    plane_.resize(local_.size());
    t_.resize(local_.size());
  }

  void element(ElementId e, std::vector<Cell>& out) {
    std::vector<Vec2> net = paint_.field->mesh().gather(e);
    for (Vec2& p : net) p = paint_.viewport(p);
    scalar_.move_to(e);
    cut(net, {Lambda{1, 0, 0}, Lambda{0, 1, 0}, Lambda{0, 0, 1}}, deepest, out);
  }

 private:
  void cut(std::span<const Vec2> net, const std::array<Lambda, 3>& corner, int depth,
           std::vector<Cell>& out) {
    Box2 box;
    for (const Vec2& p : net) box.include(p);
    Cell cell;
    const double deviation = fit(net, corner, cell);
    if (deviation <= tolerance_ || depth == 0 || box.diameter() < smallest) {
      for (int side = 0; side < 3; ++side) {
        const std::vector<Vec2> curve = bernstein::side<Vec2>(degree_, net, side);
        if (side == 0) cell.outline.move(curve.front());
        cell.outline.curve(curve);
      }
      cell.outline.close();
      out.push_back(std::move(cell));
      return;
    }
    const auto middle = [](const Lambda& a, const Lambda& b) {
      return Lambda{0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])};
    };
    const Lambda m0 = middle(corner[0], corner[1]), m1 = middle(corner[1], corner[2]),
                 m2 = middle(corner[2], corner[0]);
    const auto children = bernstein::subdivide<Vec2>(degree_, net);
    cut(children[0], {corner[0], m0, m2}, depth - 1, out);
    cut(children[1], {m0, corner[1], m1}, depth - 1, out);
    cut(children[2], {m2, m1, corner[2]}, depth - 1, out);
    cut(children[3], {m1, m2, m0}, depth - 1, out);
  }

  // The plane through the values at the corners; returns how far it is from the field at the
  // lattice.
  double fit(std::span<const Vec2> net, const std::array<Lambda, 3>& corner, Cell& cell) {
    for (std::size_t q = 0; q < local_.size(); ++q) {
      for (std::size_t c = 0; c < 3; ++c)
        lambda_[q][c] =
            local_[q][0] * corner[0][c] + local_[q][1] * corner[1][c] + local_[q][2] * corner[2][c];
      pixel_[q] = bernstein::evaluate<Vec2>(degree_, net, local_[q]);
      plane_[q] = paint_.viewport.inverse(pixel_[q]);
    }
    scalar_.evaluate(lambda_, plane_, t_);
    double lo = 1.0, hi = 0.0;
    for (double& t : t_) {
      t = (t - paint_.lo) / (paint_.hi - paint_.lo);
      lo = std::min(lo, std::clamp(t, 0.0, 1.0));
      hi = std::max(hi, std::clamp(t, 0.0, 1.0));
    }
    cell.t = 0.5 * (lo + hi);
    cell.flat = hi - lo <= flat_range;
    if (cell.flat) return 0.0;
    const std::size_t b = cell_lattice, c = local_.size() - 1;
    const Vec2 db = pixel_[b] - pixel_[0], dc = pixel_[c] - pixel_[0];
    const double det = cross(db, dc);
    if (std::abs(det) < 1e-3 * std::max(dot(db, db), dot(dc, dc))) {
      // Nearly on a line: no plane to speak of.
      cell.flat = true;
      return hi - lo;
    }
    const double tb = t_[b] - t_[0], tc = t_[c] - t_[0];
    const Vec2 gradient{{(tb * dc.y() - tc * db.y()) / det, (tc * db.x() - tb * dc.x()) / det}};
    const double steepness = dot(gradient, gradient);
    double worst = 0.0;
    for (std::size_t q = 0; q < t_.size(); ++q) {
      const double plane = t_[0] + dot(gradient, pixel_[q] - pixel_[0]);
      worst = std::max(worst, std::abs(std::clamp(plane, 0.0, 1.0) - std::clamp(t_[q], 0.0, 1.0)));
    }
    // A plane so level that its ends lie far away is a colour.
    if (steepness < 1e-12) {
      cell.flat = true;
      return hi - lo;
    }
    cell.from = pixel_[0] - (t_[0] / steepness) * gradient;
    cell.to = cell.from + (1.0 / steepness) * gradient;
    return worst;
  }

  const FieldPaint& paint_;
  double tolerance_;
  ElementScalar scalar_;
  int degree_;
  std::vector<Lambda> local_, lambda_;
  std::vector<Vec2> pixel_, plane_;
  std::vector<double> t_;
};

}  // namespace

std::vector<Cell> make_cells(const FieldPaint& paint) {
  const std::size_t elements = paint.field->mesh().element_count();
  const std::size_t budget = std::max(most_cells, elements);
  for (double tolerance = first_tolerance;; tolerance *= 2.0) {
    Cutter cutter(paint, tolerance);
    std::vector<Cell> cells;
    for (std::size_t e = 0; e < elements && (cells.size() <= budget || tolerance >= 1.0); ++e)
      cutter.element(ElementId(e), cells);
    if (cells.size() <= budget || tolerance >= 1.0) return cells;
  }
}

}  // namespace bezel::view
