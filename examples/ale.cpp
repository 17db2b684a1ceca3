// A field carried by the velocity (y^2, 1): in every step the mesh moves with the flow, then the
// domain is meshed anew and the field is transferred to the new mesh.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/base/random.hpp"
#include "bezel/bernstein/triangle.hpp"
#include "bezel/field/field.hpp"
#include "bezel/transfer/transfer.hpp"
#include "bezel/view/draw.hpp"

namespace {

using namespace bezel;
using MeshPtr = std::shared_ptr<const TriangleMesh>;

// Where the particle at p is after time t. Quadratic in p, so a mesh of degree 2 follows it
// exactly: its straight edges become parabolas.
Vec2 flow(const Vec2& p, double t) {
  const double y = p[1];
  return {{p[0] + t * (y * y + y * t + t * t / 3.0), y + t}};
}

// The mesh carried by the flow: its nodes are moved, its control points follow.
MeshPtr carried(const TriangleMesh& mesh, double t) {
  std::vector<Vec2> control(mesh.control().begin(), mesh.control().end());
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    const ElementId element(static_cast<std::int32_t>(e));
    auto nodes = bernstein::to_lagrange<Vec2>(mesh.degree(), mesh.gather(element));
    for (Vec2& p : nodes) p = flow(p, t);
    const auto moved = bernstein::from_lagrange<Vec2>(mesh.degree(), nodes);
    for (std::size_t i = 0; i < moved.size(); ++i)
      control[mesh.nodes(element)[i].index()] = moved[i];
  }
  return std::make_shared<const TriangleMesh>(
      mesh.degree(), std::move(control),
      std::vector<NodeId>(mesh.connectivity().begin(), mesh.connectivity().end()));
}

// The square [-1, 1]^2 as it is at time t, meshed anew: n rows of quadratic triangles between
// lines of constant y, straight inside, parabolas along the left and right. Inner vertices are off
// the rows' even spacing by up to `jitter` of it, so that meshes of different times do not match.
MeshPtr fresh_mesh(int n, double t, double jitter, std::uint64_t seed) {
  RandomStream random("ale", seed);
  std::vector<Vec2> point;
  const auto left = [&](double y) { return flow({{-1.0, y - t}}, t)[0]; };
  const double h = 2.0 / n;
  for (int j = 0; j <= n; ++j) {
    const double y = -1.0 + t + h * j;
    for (int i = 0; i <= n; ++i) {
      Vec2 p{{left(y) + h * i, y}};
      if (i > 0 && i < n && j > 0 && j < n)
        p += Vec2{{h * jitter * random.uniform(-1, 1), h * jitter * random.uniform(-1, 1)}};
      point.push_back(p);
    }
  }
  const auto vertex = [&](int i, int j) { return static_cast<std::size_t>(j * (n + 1) + i); };
  std::vector<std::array<std::size_t, 3>> triangles;
  for (int j = 0; j < n; ++j) {  // from left to right, by the shorter diagonal
    for (int a = 0, b = 0; a < n || b < n;) {
      const auto length = [&](int i, int k) {
        return norm(point[vertex(i, j)] - point[vertex(k, j + 1)]);
      };
      const bool below = b == n || (a < n && length(a + 1, b) < length(a, b + 1));
      if (below) {
        triangles.push_back({vertex(a, j), vertex(a + 1, j), vertex(b, j + 1)});
        ++a;
      } else {
        triangles.push_back({vertex(a, j), vertex(b + 1, j + 1), vertex(b, j + 1)});
        ++b;
      }
    }
  }
  // Degree 2: vertices first, then one control point for each edge, found by its two ends.
  std::vector<std::vector<std::pair<std::size_t, std::int32_t>>> edges(point.size());
  const auto middle = [&](std::size_t a, std::size_t b) {
    if (a > b) std::swap(a, b);
    for (const auto& [other, name] : edges[a]) {
      if (other == b) return NodeId(name);
    }
    const auto name = static_cast<std::int32_t>(point.size());
    Vec2 p = 0.5 * (point[a] + point[b]);
    const std::size_t row = static_cast<std::size_t>(n) + 1;
    if (b == a + row && (a % row == 0 || a % row == row - 1)) {
      const double right = a % row == 0 ? 0.0 : 2.0;
      const double node = left(p[1]) + right;  // on the parabola: 2 node - the mean of the ends
      p = Vec2{{2.0 * node - p[0], p[1]}};
    }
    point.push_back(p);
    edges[a].push_back({b, name});
    return NodeId(name);
  };
  std::vector<NodeId> nodes;
  for (const auto& [a, b, c] : triangles) {
    const auto id = [](std::size_t v) { return NodeId(static_cast<std::int32_t>(v)); };
    for (const NodeId node : {id(a), middle(a, b), id(b), middle(a, c), middle(b, c), id(c)})
      nodes.push_back(node);
  }
  return std::make_shared<const TriangleMesh>(2, std::move(point), std::move(nodes));
}

struct Outcome {
  double error, mass_change;
  double lo, hi;  // of all values at all times, certified
};

// One panel: a mesh, coloured by a field when there is one.
Panel panel(const MeshPtr& mesh, const std::optional<Field>& field, double t) {
  char title[16];
  std::snprintf(title, sizeof title, "t = %.2f", t);
  Layer layer;
  layer.mesh = mesh;
  layer.field = field;
  return {{layer}, title};
}

// The whole run on n rows: 20 steps from t = 0 to 1. The field lies between 0 and 1; `bounds` keeps
// its transfers there.
Outcome run(int n, bool bounds, const std::string& picture) {
  constexpr int steps = 20;
  const Formula start("exp(-4*((x-0.2)^2 + (y+0.1)^2))");
  const auto space = Space::discontinuous(fresh_mesh(n, 0.0, 0.2, 0), 2);
  Field u = sample("u", space, std::array{start});
  TransferOptions options;
  if (bounds) options.bounds = {Bounds::Kind::global, 0.0, 1.0};
  const double mass = integral(u)[0];
  Outcome outcome{0.0, 0.0, 1.0, 0.0};
  std::vector<Panel> panels = {panel(space->mesh(), u, 0.0)};
  for (int k = 1; k <= steps; ++k) {
    const double t = static_cast<double>(k) / steps;
    // The coefficients stay what they are: u is constant along the characteristics.
    const Field moved("u", Space::discontinuous(carried(u.mesh(), 1.0 / steps), 2),
                      {u.coefficients().begin(), u.coefficients().end()});
    const MeshPtr fresh = fresh_mesh(n, t, 0.2, static_cast<std::uint64_t>(k));
    const TransferResult result = transfer(std::array{moved}, fresh, options);
    u = result.fields[0];
    const FieldReport& report = result.report.fields[0];
    outcome.mass_change = std::max(outcome.mass_change, std::abs(report.mass_after - mass) / mass);
    outcome.lo = std::min(outcome.lo, report.min_after);
    outcome.hi = std::max(outcome.hi, report.max_after);
    if (k % (steps / 2) == 0) panels.push_back(panel(fresh, u, t));
  }
  if (!picture.empty()) draw(picture, panels, {.same_scale = true});
  // At t = 1 the particle at (x, y) came from (x - (y^2 - y + 1/3), y - 1).
  const Formula exact("exp(-4*((x-(y^2-y+1/3)-0.2)^2 + (y-1+0.1)^2))");
  outcome.error = error_norms(u, std::array{exact}).l2_relative;
  return outcome;
}

// The mesh alone, carried from t = 0 to 1 without being made anew, and the one that replaces it.
void draw_meshes(const std::string& path) {
  const MeshPtr start = fresh_mesh(6, 0.0, 0.0, 0);
  std::vector<Panel> panels;
  for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0})
    panels.push_back(panel(carried(*start, t), {}, t));
  panels.push_back(panel(fresh_mesh(6, 1.0, 0.2, 1), {}, 1.0));
  panels.back().title = "made anew";
  draw(path, panels, {.columns = 3, .same_scale = true});
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 3) {
    std::fprintf(stderr, "usage: example_ale MESHES.svg FIELD.png\n");
    return 2;
  }
  draw_meshes(argv[1]);
  bool conserved = true;
  for (const bool bounds : {false, true}) {
    double last = 0.0;
    for (const int n : {6, 12, 24}) {
      const Outcome outcome = run(n, bounds, n == 12 && !bounds ? argv[2] : "");
      std::printf("%s%2d rows: error %.1e", bounds ? "bounds, " : "", n, outcome.error);
      if (last > 0.0) std::printf(", order %.1f", std::log2(last / outcome.error));
      std::printf(", values %.4f to %.4f", outcome.lo, outcome.hi);
      std::printf(", mass %s\n", outcome.mass_change < 1e-13 ? "constant" : "NOT CONSTANT");
      conserved = conserved && outcome.mass_change < 1e-13;
      last = outcome.error;
    }
  }
  return conserved ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  return 3;
}
