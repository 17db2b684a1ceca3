#include "bezel/fit/lattice_relaxation.hpp"

#include <array>
#include <cmath>

#include "bezel/bernstein/index.hpp"

namespace bezel::fit {
namespace {

constexpr int most_iterations = 2000;
constexpr double residual_drop = 1e-9;

/// A small triangle: its nodes and the gradients of their hat functions. Area times stiffness is 1.
struct Small {
  std::array<std::size_t, 3> node;
  std::array<Vec2, 3> gradient;
};

class Body {
 public:
  Body(int g, std::span<const NodeId> elements) {
    const auto size = static_cast<std::size_t>(bernstein::triangle_size(g));
    for (std::size_t e = 0; e < elements.size(); e += size) {
      const auto node = [&](int j, int k) {
        return elements[e + static_cast<std::size_t>(bernstein::triangle_index(g, j, k))].index();
      };
      for (int k = 0; k < g; ++k)
        for (int j = 0; j < g - k; ++j) {
          small_.push_back({{node(j, k), node(j + 1, k), node(j, k + 1)}, {}});
          if (j + k + 2 <= g)
            small_.push_back({{node(j + 1, k), node(j + 1, k + 1), node(j, k + 1)}, {}});
        }
    }
  }

  void set_places(std::span<const Vec2> p) {
    double mean = 0.0;
    for (const Small& s : small_)
      mean += std::fabs(cross(p[s.node[1]] - p[s.node[0]], p[s.node[2]] - p[s.node[0]]));
    const double least = 1e-6 * mean / static_cast<double>(small_.size());
    for (Small& s : small_) {
      const double area = cross(p[s.node[1]] - p[s.node[0]], p[s.node[2]] - p[s.node[0]]);
      const double divisor = std::fabs(area) > least ? area : least;  // degenerate: still finite
      for (std::size_t i = 0; i < 3; ++i) {
        const Vec2 side = p[s.node[(i + 2) % 3]] - p[s.node[(i + 1) % 3]];
        s.gradient[i] = (1.0 / divisor) * Vec2{{-side.y(), side.x()}};
      }
    }
  }

  /// Forces of displacements u, Lame's constants 1.
  void forces(const std::vector<Vec2>& u, std::vector<Vec2>& out) const {
    std::fill(out.begin(), out.end(), Vec2{});
    for (const Small& s : small_) {
      double xx = 0.0, yy = 0.0, xy = 0.0;
      for (std::size_t i = 0; i < 3; ++i) {
        const Vec2 &v = u[s.node[i]], &d = s.gradient[i];
        xx += v.x() * d.x();
        yy += v.y() * d.y();
        xy += v.x() * d.y() + v.y() * d.x();
      }
      const double a = 3.0 * xx + yy, b = 3.0 * yy + xx;
      for (std::size_t i = 0; i < 3; ++i) {
        const Vec2& d = s.gradient[i];
        out[s.node[i]] += Vec2{{a * d.x() + xy * d.y(), xy * d.x() + b * d.y()}};
      }
    }
  }

  std::vector<Vec2> diagonal(std::size_t points) const {
    std::vector<Vec2> out(points);
    for (const Small& s : small_)
      for (std::size_t i = 0; i < 3; ++i) {
        const double x = s.gradient[i].x() * s.gradient[i].x(),
                     y = s.gradient[i].y() * s.gradient[i].y();
        out[s.node[i]] += Vec2{{3.0 * x + y, 3.0 * y + x}};
      }
    return out;
  }

 private:
  std::vector<Small> small_;
};

double product(const std::vector<Vec2>& a, const std::vector<Vec2>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += dot(a[i], b[i]);
  return sum;
}

/// Adds to u, zero where free, the displacements of the free points that leave no force on them.
void balance(const Body& body, const std::vector<char>& fixed, std::vector<Vec2>& u) {
  const std::size_t n = u.size();
  std::vector<Vec2> r(n), z(n), d(n), f(n);
  const std::vector<Vec2> diagonal = body.diagonal(n);
  const auto release = [&](std::vector<Vec2>& v) {
    for (std::size_t i = 0; i < n; ++i)
      if (fixed[i] != 0) v[i] = Vec2{};
  };
  const auto precondition = [&] {
    for (std::size_t i = 0; i < n; ++i)
      for (int c = 0; c < 2; ++c) z[i][c] = diagonal[i][c] > 0.0 ? r[i][c] / diagonal[i][c] : 0.0;
  };
  body.forces(u, r);
  for (Vec2& v : r) v = -v;
  release(r);
  precondition();
  d = z;
  double before = product(r, z);
  const double stop = residual_drop * residual_drop * before;
  for (int i = 0; i < most_iterations && before > stop; ++i) {
    body.forces(d, f);
    release(f);
    const double curvature = product(d, f);
    if (!(curvature > 0.0)) break;
    const double step = before / curvature;
    for (std::size_t k = 0; k < n; ++k) {
      u[k] += step * d[k];
      r[k] -= step * f[k];
    }
    precondition();
    const double now = product(r, z);
    for (std::size_t k = 0; k < n; ++k) d[k] = z[k] + (now / before) * d[k];
    before = now;
  }
}

}  // namespace

std::vector<Vec2> relax_lattice(int g, std::span<const NodeId> elements, std::vector<Vec2> control,
                                const std::vector<char>& fixed, std::span<const Vec2> target,
                                int steps) {
  Body body(g, elements);
  std::vector<Vec2> u(control.size());
  for (int step = 0; step < steps; ++step) {
    body.set_places(control);
    for (std::size_t i = 0; i < u.size(); ++i)
      u[i] = fixed[i] != 0 ? (1.0 / (steps - step)) * (target[i] - control[i]) : Vec2{};
    balance(body, fixed, u);
    for (std::size_t i = 0; i < u.size(); ++i) control[i] += u[i];
  }
  for (std::size_t i = 0; i < u.size(); ++i)
    if (fixed[i] != 0) control[i] = target[i];
  return control;
}

}  // namespace bezel::fit
