#include "bezel/field/space.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "bezel/base/error.hpp"
#include "bezel/field/element_kernel.hpp"

namespace bezel {
namespace {

// Elements thinner than this (or collinear) get a frame of this thickness: the mass matrix fails
// first.
constexpr double thinnest = 1e-10;
// sqrt(3)/2, the tangent of a corner of the equilateral triangle being twice it.
constexpr double half_root3 = 0.86602540378443864676;

bool finite(const Vec2& p) {
  return std::isfinite(p.x()) && std::isfinite(p.y());
}

/// Unit eigenvector of the larger eigenvalue of the covariance of points.
Vec2 principal_axis(std::span<const Vec2> points) {
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (const Vec2& r : points) {
    xx += r.x() * r.x();
    xy += r.x() * r.y();
    yy += r.y() * r.y();
  }
  const double half = 0.5 * (xx - yy);
  const double root = std::sqrt(half * half + xy * xy);
  const Vec2 axis = half >= 0.0 ? Vec2{root + half, xy} : Vec2{xy, root - half};
  const double length = norm(axis);
  return length > 0.0 ? axis * (1.0 / length) : Vec2{1.0, 0.0};
}

/// Points of the plane as complex numbers, for products.
Vec2 times(const Vec2& a, const Vec2& b) {
  return {a.x() * b.x() - a.y() * b.y(), a.x() * b.y() + a.y() * b.x()};
}
Vec2 cube(const Vec2& a) {
  return times(times(a, a), a);
}

/// A unit vector w with w^3 in the direction of s: Newton's method from the best of six directions,
/// in arithmetic only, since the bits of trigonometric functions depend on the machine.
Vec2 cube_root_direction(const Vec2& s) {
  const double size = norm(s);
  if (!(size > 0.0)) return {1.0, 0.0};
  const Vec2 unit = s * (1.0 / size);
  Vec2 w{1.0, 0.0};
  for (const Vec2& start : {Vec2{half_root3, 0.5}, Vec2{half_root3, -0.5}, Vec2{-1.0, 0.0}})
    if (dot(cube(start), unit) > dot(cube(w), unit)) w = start;
  for (int step = 0; step < 8; ++step) {
    const Vec2 square = times(w, w);
    const Vec2 inverse = Vec2{square.x(), -square.y()} * (1.0 / dot(square, square));
    const Vec2 last = w;
    w = (2.0 * w + times(unit, inverse)) * (1.0 / 3.0);
    w = w * (1.0 / norm(w));
    if (w == last) break;
  }
  return w;
}

void check_mesh(const std::shared_ptr<const TriangleMesh>& mesh) {
  if (!mesh) throw InputError("a space needs a mesh, found a null pointer");
}

void check_degree(int degree, int lowest, std::int64_t element = -1) {
  if (degree >= lowest && degree <= Space::max_degree) return;
  InputPlace place;
  if (element >= 0) {
    place.element_kind = "triangle";
    place.element = element;
  }
  throw InputError(place, fmt::format("field degree {} is not supported, expected {}..{}", degree,
                                      lowest, Space::max_degree));
}

void check_frame(const Frame& frame, std::int64_t element) {
  const auto fail = [&](const char* what) {
    throw InputError({{}, 0, "triangle", element}, std::string("frame: ") + what);
  };
  double size = 0.0;
  for (const Vec2& g : frame.gradient) {
    if (!finite(g)) fail("a gradient is not finite");
    size = std::max(size, norm(g));
  }
  if (!finite(frame.centre)) fail("the centre is not finite");
  const Vec2 sum = frame.gradient[0] + frame.gradient[1] + frame.gradient[2];
  if (norm(sum) > 1e-12 * size) fail("the three gradients must add up to zero");
  if (cross(frame.gradient[0], frame.gradient[1]) == 0.0)
    fail("the gradients are parallel, expected a triangle with an area");
}

/// Twice a triangle's area over the squares of two sides, above which it is far from thin.
constexpr double well_shaped = 1e-3;
/// Squares of sides between these leave room for what is made of them when the triangle is not
/// thin.
constexpr double least_square = 1e-280, largest_square = 1e300;

/// A straight triangle is its own frame; written down at once when it is not thin, nor so large or
/// small that products overflow or vanish: then false.
bool straight_frame(const Vec2& p0, const Vec2& p1, const Vec2& p2, Frame& frame) {
  const Vec2 a = p1 - p0, b = p2 - p0;
  const double det = a.x() * b.y() - a.y() * b.x();
  const double square = dot(a, a) + dot(b, b);
  if (!(det > well_shaped * square && square > least_square && square < largest_square))
    return false;
  frame.centre = p0 + (a + b) * (1.0 / 3.0);
  frame.gradient[0] = {(a.y() - b.y()) / det, (b.x() - a.x()) / det};
  frame.gradient[1] = {b.y() / det, -b.x() / det};
  frame.gradient[2] = -(frame.gradient[0] + frame.gradient[1]);
  return true;
}

/// Whether a straight triangle is its own frame, up to the rounding of barycentric coordinates at
/// its place in the plane.
bool is_own(const Frame& frame, const std::array<Vec2, 3>& corner) {
  const auto size = [](const Vec2& p) { return std::max(std::abs(p.x()), std::abs(p.y())); };
  const auto& g = frame.gradient;
  const double slope = std::max(std::max(size(g[0]), size(g[1])), size(g[2]));
  const double reach = size(frame.centre);
  double largest = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    Lambda l = frame.lambda(corner[k]);
    l[k] -= 1.0;
    largest = std::max(std::max(largest, std::abs(l[0])), std::max(std::abs(l[1]), std::abs(l[2])));
  }
  return largest <= 0x1p-51 * (2.0 + reach * slope);
}

}  // namespace

Vec2 Frame::point(const std::array<double, 3>& l) const {
  // gradient[1] . r = l1 - 1/3, gradient[2] . r = l2 - 1/3.
  const double a = l[1] - 1.0 / 3.0, b = l[2] - 1.0 / 3.0;
  const double det = cross(gradient[1], gradient[2]);
  return centre + Vec2{(a * gradient[2].y() - b * gradient[1].y()) / det,
                       (b * gradient[1].x() - a * gradient[2].x()) / det};
}

std::array<Vec2, 3> Frame::corners() const {
  return {point({1.0, 0.0, 0.0}), point({0.0, 1.0, 0.0}), point({0.0, 0.0, 1.0})};
}

Frame element_frame(std::span<const Vec2> control) {
  if (control.empty()) throw InputError("an element frame needs control points, found none");
  Box2 box;
  for (const Vec2& p : control) {
    if (!finite(p)) throw InputError("a control point is not finite");
    box.include(p);
  }
  if (!(box.diameter() > 0.0))
    throw InputError("all control points of an element coincide, expected a triangle");

  Frame own;
  if (control.size() == 3 && straight_frame(control[0], control[1], control[2], own)) return own;

  // z = L^-1 Q^T (p - start): covariance 1. Turning to the principal axes first keeps the digits of
  // thin elements.
  const std::size_t n = control.size();
  Vec2 mean{};
  for (const Vec2& p : control) mean += p - box.lo;
  const Vec2 start = box.lo + mean * (1.0 / static_cast<double>(n));
  std::vector<Vec2> z(control.begin(), control.end());
  for (Vec2& p : z) p -= start;
  const Vec2 along = principal_axis(z), across{-along.y(), along.x()};
  double ll = 0.0, lc = 0.0, cc = 0.0;
  for (Vec2& p : z) {
    p = {dot(along, p), dot(across, p)};
    ll += p.x() * p.x();
    lc += p.x() * p.y();
    cc += p.y() * p.y();
  }
  const double l11 = std::sqrt(ll), l21 = lc / l11;
  const double l22 = std::max(std::sqrt(std::max(0.0, cc - l21 * l21)), thinnest * l11);
  for (Vec2& p : z) p = {p.x() / l11, (p.y() - p.x() / l11 * l21) / l22};

  // The equilateral triangle whose three-fold direction is that of the points, corner 0 nearest to
  // the first point.
  Vec2 third{};
  for (const Vec2& p : z) third += cube(p);
  const Vec2 root = cube_root_direction(third);
  const Vec2 turn{-0.5, half_root3};
  std::array<Vec2, 3> d{root, times(root, turn), times(times(root, turn), turn)};
  while (dot(d[0], z[0]) < dot(d[1], z[0]) || dot(d[0], z[0]) < dot(d[2], z[0]))
    d = {d[1], d[2], d[0]};

  // The smallest such triangle around all points: side k lies at distance reach[k] from z = 0.
  std::array<double, 3> reach{};
  for (std::size_t k = 0; k < 3; ++k) {
    reach[k] = -dot(d[k], z[0]);
    for (const Vec2& p : z) reach[k] = std::max(reach[k], -dot(d[k], p));
  }
  const double inradius = (reach[0] + reach[1] + reach[2]) / 3.0;
  // d_k . c = inradius - reach_k, with sum over k of d_k d_k^T = 3/2.
  Vec2 c{};
  for (std::size_t k = 0; k < 3; ++k) c += d[k] * (2.0 / 3.0 * (inradius - reach[k]));

  // lambda_k = 1/3 + d_k . (z - c) / (3 inradius).
  Frame frame;
  const double y = l21 * c.x() + l22 * c.y();
  frame.centre = start + along * (l11 * c.x()) + across * y;
  for (std::size_t k = 0; k < 2; ++k) {
    const Vec2 g = d[k] * (1.0 / (3.0 * inradius));
    const double gy = g.y() / l22, gx = (g.x() - gy * l21) / l11;  // L^-T g
    frame.gradient[k] = along * gx + across * gy;
  }
  frame.gradient[2] = -(frame.gradient[0] + frame.gradient[1]);
  return frame;
}

std::size_t Space::offset(ElementId e) const {
  return uniform_degree_ >= 0
             ? e.index() * static_cast<std::size_t>(bernstein::triangle_size(uniform_degree_))
             : offsets_[e.index()];
}

std::shared_ptr<Space> Space::uniform(std::shared_ptr<const TriangleMesh> mesh, int degree) {
  std::shared_ptr<Space> space(new Space);
  space->mesh_ = std::move(mesh);
  const std::size_t n = space->mesh_->element_count();
  space->uniform_degree_ = space->highest_degree_ = n > 0 ? degree : 0;
  space->coefficient_count_ = n * static_cast<std::size_t>(bernstein::triangle_size(degree));
  space->dof_count_ = space->coefficient_count_;
  return space;
}

std::shared_ptr<Space> Space::by_element(std::shared_ptr<const TriangleMesh> mesh,
                                         std::vector<int> degrees) {
  const std::size_t n = mesh->element_count();
  if (degrees.size() != n)
    throw InputError(fmt::format("found {} degrees, expected one for each of the {} elements",
                                 degrees.size(), n));
  int highest = 0;
  for (std::size_t e = 0; e < n; ++e) {
    check_degree(degrees[e], 0, static_cast<std::int64_t>(e));
    highest = std::max(highest, degrees[e]);
  }
  if (std::all_of(degrees.begin(), degrees.end(), [&](int d) { return d == highest; }))
    return uniform(std::move(mesh), highest);
  std::shared_ptr<Space> space(new Space);
  space->mesh_ = std::move(mesh);
  space->highest_degree_ = highest;
  space->offsets_.reserve(n);
  for (const int d : degrees) {
    space->offsets_.push_back(space->coefficient_count_);
    space->coefficient_count_ += static_cast<std::size_t>(bernstein::triangle_size(d));
  }
  space->degrees_ = std::move(degrees);
  space->dof_count_ = space->coefficient_count_;
  return space;
}

void Space::make_frames(int threads) {
  basis_ = Basis::physical;
  frames_.resize(mesh_->element_count());
  const std::size_t size = static_cast<std::size_t>(mesh_->nodes_per_element());
  field_detail::for_chunks(frames_.size(), threads, [&](std::size_t from, std::size_t to) {
    std::array<Vec2, static_cast<std::size_t>(field_detail::largest_size)> control;
    for (std::size_t e = from; e < to; ++e) {
      const auto nodes = mesh_->nodes(ElementId(e));
      for (std::size_t n = 0; n < size; ++n) control[n] = mesh_->control(nodes[n]);
      if (size == 3 && straight_frame(control[0], control[1], control[2], frames_[e])) continue;
      try {
        frames_[e] = element_frame({control.data(), size});
      } catch (const InputError& error) {
        throw InputError({{}, 0, "triangle", static_cast<std::int64_t>(e)}, error.message());
      }
      check_frame(frames_[e], static_cast<std::int64_t>(e));
    }
  });
}

void Space::compare_frames(int threads) {
  if (mesh_->degree() > 1) return;
  own_frame_.resize(frames_.size());
  field_detail::for_chunks(frames_.size(), threads, [&](std::size_t from, std::size_t to) {
    for (std::size_t e = from; e < to; ++e)
      own_frame_[e] = is_own(frames_[e], field_detail::corners(*mesh_, ElementId(e))) ? 1 : 0;
  });
  own_frames_ = std::find(own_frame_.begin(), own_frame_.end(), 0) == own_frame_.end();
  if (own_frames_) own_frame_ = {};
}

std::shared_ptr<const Space> Space::discontinuous(std::shared_ptr<const TriangleMesh> mesh,
                                                  int degree, Basis basis, int threads) {
  check_mesh(mesh);
  check_degree(degree, 0);
  std::shared_ptr<Space> space = uniform(std::move(mesh), degree);
  if (basis == Basis::physical) {
    space->make_frames(threads);
    space->compare_frames(threads);
  }
  return space;
}

std::shared_ptr<const Space> Space::discontinuous(std::shared_ptr<const TriangleMesh> mesh,
                                                  std::vector<int> degrees, Basis basis) {
  check_mesh(mesh);
  std::shared_ptr<Space> space = by_element(std::move(mesh), std::move(degrees));
  if (basis == Basis::physical) {
    space->make_frames(0);
    space->compare_frames(0);
  }
  return space;
}

std::shared_ptr<const Space> Space::discontinuous(std::shared_ptr<const TriangleMesh> mesh,
                                                  std::vector<int> degrees,
                                                  std::vector<Frame> frames) {
  check_mesh(mesh);
  const std::size_t n = mesh->element_count();
  if (frames.size() != n)
    throw InputError(
        fmt::format("found {} frames, expected one for each of the {} elements", frames.size(), n));
  for (std::size_t e = 0; e < n; ++e) check_frame(frames[e], static_cast<std::int64_t>(e));
  std::shared_ptr<Space> space = by_element(std::move(mesh), std::move(degrees));
  space->basis_ = Basis::physical;
  space->frames_ = std::move(frames);
  space->compare_frames(0);
  return space;
}

std::shared_ptr<const Space> Space::continuous(std::shared_ptr<const TriangleMesh> mesh, int degree,
                                               Basis basis) {
  check_mesh(mesh);
  if (basis == Basis::physical)
    throw InputError(
        "a continuous space cannot use the physical basis: it is non-conforming on curved edges; "
        "use the reference basis, or a discontinuous space");
  check_degree(degree, 1);
  std::shared_ptr<Space> space = uniform(mesh, degree);
  space->continuity_ = Continuity::continuous;

  const std::size_t per_edge = static_cast<std::size_t>(degree - 1);
  const std::size_t per_element =
      per_edge * static_cast<std::size_t>(degree - 2 > 0 ? degree - 2 : 0) / 2;
  const std::size_t elements = mesh->element_count();
  const std::size_t edge_start = mesh->vertex_count();
  const std::size_t inner_start = edge_start + mesh->edge_count() * per_edge;
  space->dof_count_ = inner_start + elements * per_element;
  if (space->dof_count_ > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    throw InputError(
        fmt::format("a continuous space of {} degrees of freedom is too large, "
                    "the limit is {}",
                    space->dof_count_, std::numeric_limits<std::int32_t>::max()));
  for (std::size_t e = 0; e < mesh->edge_count(); ++e)
    if (mesh->adjacent(EdgeId(e)).size() > 2)
      throw InputError({{}, 0, "edge", static_cast<std::int64_t>(e)},
                       fmt::format("{} elements lie along it, a continuous space needs at most 2 "
                                   "(no hanging vertices)",
                                   mesh->adjacent(EdgeId(e)).size()));

  // Vertices are numbered by ascending NodeId.
  const int g = mesh->degree();
  std::vector<std::int32_t> vertex(mesh->node_count(), -1);
  for (std::size_t e = 0; e < elements; ++e)
    for (int corner = 0; corner < 3; ++corner)
      vertex[mesh->nodes(
                     ElementId(e))[static_cast<std::size_t>(bernstein::triangle_corner(g, corner))]
                 .index()] = 0;
  std::int32_t next = 0;
  for (std::int32_t& number : vertex)
    if (number == 0) number = next++;

  const std::size_t size = static_cast<std::size_t>(bernstein::triangle_size(degree));
  space->dofs_.resize(elements * size);
  for (std::size_t e = 0; e < elements; ++e) {
    const auto nodes = mesh->nodes(ElementId(e));
    std::int32_t* dofs = space->dofs_.data() + e * size;
    for (int corner = 0; corner < 3; ++corner)
      dofs[bernstein::triangle_corner(degree, corner)] =
          vertex[nodes[static_cast<std::size_t>(bernstein::triangle_corner(g, corner))].index()];
    const std::array<SideEdge, 3> edges = mesh->edges(ElementId(e));
    for (int side = 0; side < 3; ++side) {
      const SideEdge& edge = edges[static_cast<std::size_t>(side)];
      for (int m = 1; m < degree; ++m) {
        const int along = edge.reversed ? degree - m : m;
        dofs[bernstein::triangle_side_index(degree, side, m)] = static_cast<std::int32_t>(
            edge_start + edge.edge.index() * per_edge + static_cast<std::size_t>(along - 1));
      }
    }
    std::size_t inner = inner_start + e * per_element;
    for (int k = 1; k < degree; ++k)
      for (int j = 1; j + k < degree; ++j)
        dofs[bernstein::triangle_index(degree, j, k)] = static_cast<std::int32_t>(inner++);
  }
  return space;
}

std::span<const std::int32_t> Space::dofs(ElementId e) const {
  if (dofs_.empty()) return {};
  const auto size = static_cast<std::size_t>(bernstein::triangle_size(uniform_degree_));
  return {dofs_.data() + e.index() * size, size};
}

std::vector<double> Space::expand(std::span<const double> dofs, int components) const {
  if (components < 1)
    throw InputError(fmt::format("found {} components, expected at least 1", components));
  const auto n = static_cast<std::size_t>(components);
  if (dofs.size() != dof_count_ * n)
    throw InputError(
        fmt::format("found {} values, expected {} (degrees of freedom {} x components {})",
                    dofs.size(), dof_count_ * n, dof_count_, components));
  if (continuity_ == Continuity::discontinuous) return {dofs.begin(), dofs.end()};
  std::vector<double> coefficients(coefficient_count_ * n);
  for (std::size_t i = 0; i < coefficient_count_; ++i)
    for (std::size_t c = 0; c < n; ++c)
      coefficients[i * n + c] = dofs[static_cast<std::size_t>(dofs_[i]) * n + c];
  return coefficients;
}

}  // namespace bezel
