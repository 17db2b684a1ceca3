#include "bezel/transfer/pair_fit.hpp"
#include "bezel/transfer/piece_batch.hpp"

#include <algorithm>
#include <cmath>

#include "bezel/bernstein/index.hpp"
#include "bezel/bernstein/triangle_kernel.hpp"
#include "bezel/numeric/sum.hpp"
#include "bezel/transfer/moments.hpp"

namespace bezel::detail {
namespace {

/// Gauss points on a curve that is pulled back by an inverse map, beyond what a polynomial needs.
constexpr int pulled_extra = 1;
/// ... where nothing else is inexact.
constexpr int pulled_extra_plane = 2;
/// Degrees beyond the donor's own that the composition of a mapped donor with another map gets,
/// and more where that is not enough.
constexpr int composed_extra = 2;
constexpr int more_degrees = 3;
/// What an interpolant may miss of a function of the donor's coordinates, as a fraction of their
/// change over the region.
constexpr double composed_accuracy = 1e-3;
/// Largest growth of a donor's polynomial from the donor to the points where it is interpolated: in
/// the box around a region that is thin and lies across the coordinates they are far outside.
constexpr double steepest_values = 256.0;
/// Places for donor elements whose maps are kept.
constexpr std::size_t kept_donors = 256;
/// Highest degree of fields that are not mapped: above, quadrature is more accurate.
constexpr int max_plane_degree = 5;
/// A point of a curve in an element may lie this much outside it, in barycentrics.
constexpr double outside = 1e-6;
/// The frame of a reference triangle: its bounding box is in it.
constexpr double reference_half = 2.0 / 3.0;

int target_degree(const Group& g, const OverlayMesh& target, int degree) {
  return degree + (g.target_mapped ? 2 * (target.degree - 1) : 0);
}

/// Degree of the donor's interpolant in the target's coordinates.
int fit_degree(const Group& g, const OverlayMesh& target, int degree) {
  if (degree == 0) return 0;
  if (!g.donor_mapped && !g.target_mapped) return degree;
  if (!g.donor_mapped) return degree * target.degree;
  return degree + composed_extra + (target.degree > 2 ? 1 : 0);
}

/// Largest tails (fit_tails) of the donor's coordinates u, interpolated with degree m: where they
/// fall off like r^j, the first part of a polynomial of degree p in u that degree m misses is
/// u^(p-1) times the part of degree m - p + 2 of u.
std::array<double, 2> largest_tails(int m, int p) {
  static const auto all = [] {
    std::array<std::array<std::array<double, 2>, max_fit_degree + 1>, max_fit_degree + 1> made{};
    for (int fit = 2; fit <= max_fit_degree; ++fit) {
      for (int degree = 1; degree <= fit; ++degree) {
        const double rate = std::pow(composed_accuracy, 1.0 / (fit - degree + 1));
        made[static_cast<std::size_t>(fit)][static_cast<std::size_t>(degree)] = {
            std::pow(rate, fit - 1), std::pow(rate, fit - 2)};
      }
    }
    return made;
  }();
  return all[static_cast<std::size_t>(m)][static_cast<std::size_t>(p)];
}

int mass_degree(const OverlayMesh& donor, int degree) {
  return degree + 2 * (donor.degree - 1);
}

/// Whether polynomials of degree p stay small at the points with these barycentrics 1 and 2.
bool is_tame(int p, std::size_t padded, const double* u, const double* v) {
  double largest[lanes] = {};
  for (std::size_t at = 0; at < padded; at += lanes) {
    for (std::size_t l = 0; l < lanes; ++l) {
      const double a = u[at + l], b = v[at + l];
      const double sizes = std::abs(1.0 - a - b) + std::abs(a) + std::abs(b);
      largest[l] = sizes > largest[l] ? sizes : largest[l];
    }
  }
  const double most = *std::max_element(largest, largest + lanes);
  double growth = 1.0;
  for (int i = 0; i < p; ++i) growth *= most;
  return growth <= steepest_values;
}

void zero(std::vector<double>& array, std::size_t size) {
  array.assign(size, 0.0);
}

bool inside(const CurvePoints& points) {
  bool all = true;
  for (std::size_t i = 0; i < points.count; ++i)
    all = all && points.x[i] >= -outside && points.y[i] >= -outside &&
          points.x[i] + points.y[i] <= 1.0 + outside;
  return all;
}

/// Fills the last block up with points that count nothing.
void pad(CurvePoints& points) {
  const std::size_t count = points.count, whole = padded_to_lanes(count);
  for (std::size_t i = count; i < whole; ++i) {
    points.x[i] = points.x[count - 1];
    points.y[i] = points.y[count - 1];
    points.dx[i] = points.dy[i] = 0.0;
  }
}

}  // namespace

PairFit::PairFit(const OverlayMesh& donor, const OverlayMesh& target, std::size_t groups)
    : donor_(donor), target_(target), donors_(groups) {}

bool PairFit::can(const Group& g, const OverlayMesh& donor, const OverlayMesh& target) {
  const int pd = g.donor_degree.highest;
  const int pt = g.target_space->highest_degree();
  if (!g.donor_mapped && !g.target_mapped && std::max(pd, pt) > max_plane_degree) return false;
  const int k = target_degree(g, target, pt);
  const int m = fit_degree(g, target, pd);
  return m <= max_fit_degree && k < static_cast<int>(2 * lanes) && m + k <= max_fit_moments &&
         (!g.donor_mapped || mass_degree(donor, pd) <= max_fit_degree);
}

void PairFit::reserve(const FitTable& table, std::size_t components, int moments) {
  const auto grow = [](std::vector<double>& array, std::size_t size) {
    if (array.size() < size) array.resize(size);
  };
  for (std::vector<double>* array : {&u_, &v_, &x_, &y_, &du_, &dv_, &det_})
    grow(*array, table.padded);
  grow(values_, components * table.padded);
  grow(terms_, components * table.terms);
  grow(moments_, fit_rows(moments) + 2 * lanes);
}

const PairFit::Rule& PairFit::rule(int points) {
  const auto n = static_cast<std::size_t>(points);
  if (rules_.size() <= n) rules_.resize(n + 1);
  Rule& made = rules_[n];
  if (made.count == 0) {
    const IntervalRule gauss = gauss_legendre(points);
    made.count = n;
    made.blocks = padded_to_lanes(n) / lanes;
    made.node.assign(gauss.node.begin(), gauss.node.end());
    made.weight.assign(gauss.weight.begin(), gauss.weight.end());
    made.node.resize(padded_to_lanes(n), gauss.node.back());
    made.weight.resize(padded_to_lanes(n), 0.0);
  }
  return made;
}

// Points of an element's own side: straight in its reference coordinates.
void PairFit::append_side(const OverlayMesh& mesh, std::int32_t element, const Part& part,
                          int points, CurvePoints& to) {
  static constexpr std::array<std::array<double, 2>, 3> corner = {
      {{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}}};
  const auto& sides = mesh.element_edges[static_cast<std::size_t>(element)];
  std::size_t side = 0;
  while (side < 2 && sides[side].edge.value != part.edge) ++side;
  const bool reversed = sides[side].reversed;
  const auto &a = corner[side], &b = corner[(side + 1) % 3];
  const double ax = b[0] - a[0], ay = b[1] - a[1];
  const double step = part.to - part.from;
  const double slope = reversed ? -step : step;
  const Rule& line = rule(points);
  const std::size_t first = to.append(line.count);
  for (std::size_t i = 0; i < line.count; ++i) {
    const double t = part.from + step * line.node[i];
    const double m = reversed ? 1.0 - t : t;
    to.x[first + i] = a[0] + m * ax;
    to.y[first + i] = a[1] + m * ay;
    to.dx[first + i] = ax * slope * line.weight[i];
    to.dy[first + i] = ay * slope * line.weight[i];
  }
}

std::size_t PairFit::append_curve(std::span<const Vec2> control, const Part& part,
                                  const Vec2& origin, int points, CurvePoints& to) {
  const Rule& line = rule(points);
  const std::size_t first = to.append(line.count);
  to.append(line.blocks * lanes - line.count);  // written, then given back
  to.count = first + line.count;
  fit_curve(control, origin, part.from, part.to - part.from, line.blocks, line.node.data(),
            line.weight.data(), to.x.data() + first, to.y.data() + first, to.dx.data() + first,
            to.dy.data() + first);
  return first;
}

void PairFit::make_target_map() {
  if (g_->target_mapped) {
    target_map_.set(target_.degree, target_.element(t_));
    centre_ = {1.0 / 3.0, 1.0 / 3.0};
    return;
  }
  const TargetPlace place = place_of(g_->target_frame[static_cast<std::size_t>(t_)]);
  target_map_.set_affine(place.centre, place.along_first, place.along_second);
  centre_ = {0.0, 0.0};
}

void PairFit::begin(std::size_t i, const Group& g, std::int32_t t,
                    std::span<const Segment> segments, bool around_a_constant) {
  group_ = i;
  g_ = &g;
  t_ = t;
  segments_ = segments;
  target_degree_ = target_degree(g, target_, g.target_space->degree(ElementId(t)));
  make_target_map();
  zero(sums_, static_cast<std::size_t>(g.components + 1) * fit_rows(target_degree_));
  any_ = false;
  // Of a donor, so that a constant leaves nothing to integrate.
  zero(constant_, static_cast<std::size_t>(g.components));
  std::int32_t last = exterior;
  bool any = false;
  for (const Segment& segment : segments) {
    const std::int32_t d = segment.donor;
    if (!around_a_constant || d == exterior || d == last) continue;
    const std::vector<double>& mean = donor_of(d).mean;
    if (any)
      keep_smaller(constant_, mean.data());
    else
      constant_ = mean;
    any = true;
    last = d;
  }
  make_target_points(segments);
}

void PairFit::make_target_points(std::span<const Segment> segments) {
  own_.clear();
  pulled_.clear();
  runs_.resize(segments.size());
  if (seen_.size() < donor_.edge_count()) seen_.resize(donor_.edge_count());
  ++stamp_;
  // Degrees that interpolation adds are small and need no exact rule.
  const int pd = g_->donor_degree.highest;
  const int degree =
      target_degree_ + (g_->donor_mapped && pd > 0 ? pd + 1 : fit_degree(*g_, target_, pd));
  const bool mapped = g_->target_mapped;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Segment& segment = segments[i];
    Run& run = runs_[i];
    if (segment.target.edge >= 0 && mapped) {
      run = {static_cast<std::uint32_t>(own_.count), 0, false, false};
      append_side(target_, t_, segment.target, degree / 2 + 1, own_);
      run.count = static_cast<std::uint32_t>(own_.count) - run.first;
      continue;
    }
    const bool source = segment.target.edge < 0;
    if (source) {
      // The donor on the other side has the same piece, reversed.
      Seen& seen = seen_[static_cast<std::size_t>(segment.source.edge)];
      if (seen.stamp == stamp_) {
        const Part& other = segments[seen.segment].source;
        if (other.from == segment.source.to && other.to == segment.source.from) {
          run = runs_[seen.segment];
          run.reversed = true;
          continue;
        }
      }
      seen = {stamp_, static_cast<std::uint32_t>(i)};
    }
    const OverlayMesh& mesh = source ? donor_ : target_;
    const Part& part = source ? segment.source : segment.target;
    const int extra = g_->donor_mapped ? pulled_extra : pulled_extra_plane;
    const int points =
        mapped ? degree / 2 + 1 + extra : (degree * mesh.degree + 2 * mesh.degree - 2) / 2 + 1;
    const Vec2 origin = mapped ? Vec2{} : target_map_.base;
    const std::size_t first = append_curve(mesh.edge(part.edge), part, origin, points, pulled_);
    run = {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(pulled_.count - first),
           true, false};
  }
  ready_ = true;
  if (pulled_.count == 0) return;
  pad(pulled_);
  const std::size_t whole = padded_to_lanes(pulled_.count);
  if (mapped) {
    ready_ = fit_invert(target_map_, whole / lanes, pulled_.x.data(), pulled_.y.data(),
                        pulled_.x.data(), pulled_.y.data(), pulled_.dx.data(), pulled_.dy.data()) &&
             inside(pulled_);
    return;
  }
  const Frame& frame = g_->target_frame[static_cast<std::size_t>(t_)];
  const Vec2 &a = frame.gradient[1], &b = frame.gradient[2];
  for (std::size_t i = 0; i < whole; ++i) {
    const double x = pulled_.x[i], y = pulled_.y[i], dx = pulled_.dx[i], dy = pulled_.dy[i];
    pulled_.x[i] = a[0] * x + a[1] * y;
    pulled_.y[i] = b[0] * x + b[1] * y;
    pulled_.dx[i] = a[0] * dx + a[1] * dy;
    pulled_.dy[i] = b[0] * dx + b[1] * dy;
  }
}

// The boundary of a region, counter-clockwise.
void PairFit::collect(std::size_t begin, std::size_t end) {
  boundary_.clear();
  for (std::size_t i = begin; i < end; ++i) {
    const Run& run = runs_[i];
    const CurvePoints& from = run.pulled ? pulled_ : own_;
    const std::size_t first = boundary_.append(run.count);
    const double sign = run.reversed ? -1.0 : 1.0;
    for (std::size_t k = 0; k < run.count; ++k) {
      boundary_.x[first + k] = from.x[run.first + k];
      boundary_.y[first + k] = from.y[run.first + k];
      boundary_.dx[first + k] = sign * from.dx[run.first + k];
      boundary_.dy[first + k] = sign * from.dy[run.first + k];
    }
  }
  pad(boundary_);
}

const PairFit::Donor& PairFit::donor_of(std::int32_t d) {
  std::vector<Donor>& kept = donors_[group_];
  if (kept.empty()) kept.resize(kept_donors);
  Donor& donor = kept[static_cast<std::size_t>(d) % kept_donors];
  if (donor.element == d) return donor;
  donor.element = d;
  const auto nc = static_cast<std::size_t>(g_->components);
  donor.mean.resize(nc);
  g_->constants_of(donor_, d, donor.mean);
  if (!g_->donor_mapped) return donor;
  donor.map.set(donor_.degree, donor_.element(d));
  const int pd = g_->donor_space->degree(ElementId(d));
  const int degree = mass_degree(donor_, pd);
  const FitTable& table = fit_table(degree);
  reserve(table, nc, degree);
  for (std::size_t q = 0; q < table.padded; ++q) {
    u_[q] = 1.0 / 3.0 + reference_half * table.x[q];
    v_[q] = 1.0 / 3.0 + reference_half * table.y[q];
  }
  fit_map(donor.map, table.padded / lanes, u_.data(), v_.data(), x_.data(), y_.data(), det_.data());
  fit_values(pd, g_->components, g_->donor_scaled(d).data(), donor.mean.data(), table.padded,
             u_.data(), v_.data(), values_.data());
  for (std::size_t c = 0; c < nc; ++c)
    for (std::size_t q = 0; q < table.padded; ++q) values_[c * table.padded + q] *= det_[q];
  fit_interpolate(table, g_->components, values_.data(), terms_.data());
  const std::size_t rows = fit_rows(degree), stride = fit_stride(degree);
  zero(donor.mass, nc * rows);
  for (std::size_t c = 0; c < nc; ++c) {
    const double* term = terms_.data() + c * table.terms;
    for (int b = 0; b <= degree; ++b)
      for (int a = 0; a <= degree - b; ++a, ++term)
        donor.mass[c * rows + static_cast<std::size_t>(b) * stride + static_cast<std::size_t>(a)] =
            reference_half * reference_half * *term;
  }
  return donor;
}

// Fills in du_, dv_ from the points x_, y_ in the plane.
bool PairFit::donor_places(std::int32_t d, std::size_t padded) {
  if (g_->donor_mapped)
    return fit_invert(donor_of(d).map, padded / lanes, x_.data(), y_.data(), du_.data(), dv_.data(),
                      nullptr, nullptr);
  const Frame& frame = g_->donor_frame[static_cast<std::size_t>(d)];
  const Vec2 &a = frame.gradient[1], &b = frame.gradient[2];
  for (std::size_t q = 0; q < padded; ++q) {
    const double x = x_[q] - frame.centre[0], y = y_[q] - frame.centre[1];
    du_[q] = 1.0 / 3.0 + (a[0] * x + a[1] * y);
    dv_[q] = 1.0 / 3.0 + (b[0] * x + b[1] * y);
  }
  return true;
}

// The points of a table in a frame and their places in the donor; false when degree m is not
// enough for polynomials of degree p there.
bool PairFit::place_points(std::int32_t d, int m, int p, const FitFrame& frame) {
  const FitTable& table = fit_table(m);
  reserve(table, static_cast<std::size_t>(g_->components), m + target_degree_);
  for (std::size_t q = 0; q < table.padded; ++q) {
    u_[q] = frame.centre[0] + frame.half[0] * table.x[q];
    v_[q] = frame.centre[1] + frame.half[1] * table.y[q];
  }
  fit_map(target_map_, table.padded / lanes, u_.data(), v_.data(), x_.data(), y_.data(), nullptr);
  if (!donor_places(d, table.padded) || !is_tame(p, table.padded, du_.data(), dv_.data()))
    return false;
  if (!g_->donor_mapped || p == 0) return true;
  const auto tails = fit_tails(table, du_.data(), dv_.data());
  const auto largest = largest_tails(m, p);
  return tails[0] <= largest[0] && tails[1] <= largest[1];
}

bool PairFit::add(std::int32_t d, std::size_t begin, std::size_t end, double area,
                  std::span<double> mass) {
  const int pd = g_->donor_space->degree(ElementId(d));
  const Donor& donor = donor_of(d);
  if (g_->donor_mapped)
    donor_mass(donor, begin, end, area, {}, mass);
  else if (g_->target_mapped && !plane_mass(d, begin, end, area, mass))
    return false;
  if (!ready_) return false;
  collect(begin, end);
  FitFrame frame = fit_frame(boundary_);
  for (double& half : frame.half) half = std::max(half, 1e-12);
  int m = fit_degree(*g_, target_, pd);
  while (!place_points(d, m, pd, frame)) {
    m += more_degrees;
    if (m > max_fit_degree || m + target_degree_ > max_fit_moments) return false;
  }
  const FitTable& table = fit_table(m);
  const auto nc = static_cast<std::size_t>(g_->components);
  fit_values(pd, g_->components, g_->donor_scaled(d).data(), constant_.data(), table.padded,
             du_.data(), dv_.data(), values_.data());
  fit_interpolate(table, g_->components, values_.data(), terms_.data());
  fit_moments(m + target_degree_, boundary_, frame, moments_.data());
  fit_add(table, target_degree_, g_->components, terms_.data(), moments_.data(), frame, centre_,
          sums_.data());
  any_ = true;
  if (g_->donor_mapped || g_->target_mapped) return true;
  const double scale = frame.half[0] * frame.half[1] *
                       (target_map_.x[1] * target_map_.y[2] - target_map_.x[2] * target_map_.y[1]);
  const std::size_t stride = fit_stride(m + target_degree_);
  for (std::size_t c = 0; c < nc; ++c) {
    const double* term = terms_.data() + c * table.terms;
    double sum = 0.0;
    for (int b = 0; b <= m; ++b)
      for (int a = 0; a <= m - b; ++a, ++term)
        sum += *term * moments_[static_cast<std::size_t>(b) * stride + static_cast<std::size_t>(a)];
    // Around the donor's mean, so that a constant gives its area exactly.
    const double mean = donor.mean[c];
    mass[c] = mean * area + scale * (sum - (mean - constant_[c]) * moments_[0]);
  }
  return true;
}

int PairFit::mass_points(int degree) {
  return degree / 2 + 1 + pulled_extra;
}

void PairFit::mass_of(std::int32_t d, std::size_t begin, std::size_t end, double area,
                      std::span<const std::array<Vec2, 2>> bridges, std::span<double> mass) {
  donor_mass(donor_of(d), begin, end, area, bridges, mass);
}

// By a rule whose parts cancel between neighbouring target elements: along the donor's own sides
// exact, along a target edge with nodes that both elements beside it have.
void PairFit::donor_mass(const Donor& donor, std::size_t begin, std::size_t end, double area,
                         std::span<const std::array<Vec2, 2>> bridges, std::span<double> mass) {
  const int degree = mass_degree(donor_, g_->donor_space->degree(ElementId(donor.element)));
  const int pulled = mass_points(degree);
  boundary_.clear();
  for (std::size_t i = begin; i < end; ++i) {
    const Segment& segment = segments_[i];
    if (segment.source.edge < 0)
      append_curve(target_.edge(segment.target.edge), segment.target, Vec2{}, pulled, boundary_);
  }
  if (boundary_.count > 0) {
    pad(boundary_);
    double *x = boundary_.x.data(), *y = boundary_.y.data();
    if (!fit_invert(donor.map, padded_to_lanes(boundary_.count) / lanes, x, y, x, y,
                    boundary_.dx.data(), boundary_.dy.data()) ||
        !inside(boundary_)) {
      boundary_.clear();
      for (std::size_t i = begin; i < end; ++i)
        if (segments_[i].source.edge < 0)
          append_one_by_one(donor.element, segments_[i].target, pulled);
    }
  }
  for (std::size_t i = begin; i < end; ++i)
    if (segments_[i].source.edge >= 0)
      append_side(donor_, donor.element, segments_[i].source, degree / 2 + 1, boundary_);
  for (const auto& [from, step] : bridges) {
    std::array<double, 3> lambda{};
    if (!invert_map(donor_.degree, donor_.element(donor.element), from + 0.5 * step, lambda, false))
      continue;
    const std::size_t at = boundary_.append(1);
    pull_point(donor.element, lambda, step, at);
  }
  pad(boundary_);
  const FitFrame frame{{1.0 / 3.0, 1.0 / 3.0}, {reference_half, reference_half}};
  const std::size_t rows = fit_rows(degree);
  if (moments_.size() < rows) moments_.resize(rows);
  fit_moments(degree, boundary_, frame, moments_.data());
  for (std::size_t c = 0; c < mass.size(); ++c)
    mass[c] = donor.mean[c] * area + fit_dot(degree, donor.mass.data() + c * rows, moments_.data());
}

// Where Newton's method from the affine map fails: each point from the one before.
void PairFit::append_one_by_one(std::int32_t d, const Part& part, int points) {
  const Rule& line = rule(points);
  const std::size_t first = boundary_.append(line.count);
  const double step = part.to - part.from;
  std::array<double, 3> lambda{};
  bool warm = false;
  for (std::size_t i = 0; i < line.count; ++i) {
    const auto at = edge_point(target_.edge(part.edge), part.from + step * line.node[i]);
    warm = invert_map(donor_.degree, donor_.element(d), at.value, lambda, warm);
    pull_point(d, lambda, at.derivative * (step * line.weight[i]), first + i);
  }
}

void PairFit::pull_point(std::int32_t d, const std::array<double, 3>& lambda, const Vec2& step,
                         std::size_t at) {
  const auto map = bernstein::kernel::evaluate_gradient_unchecked<Vec2, double>(
      donor_.degree, donor_.element(d).data(), lambda);
  const double scale = 1.0 / cross(map.du, map.dv);
  boundary_.x[at] = lambda[1];
  boundary_.y[at] = lambda[2];
  boundary_.dx[at] = cross(step, map.dv) * scale;
  boundary_.dy[at] = cross(map.du, step) * scale;
}

// Exactly, in the plane.
bool PairFit::plane_mass(std::int32_t d, std::size_t begin, std::size_t end, double area,
                         std::span<double> mass) {
  const int pd = g_->donor_space->degree(ElementId(d));
  const Vec2 origin = target_map_.base;
  boundary_.clear();
  for (std::size_t i = begin; i < end; ++i) {
    const Segment& segment = segments_[i];
    const bool source = segment.target.edge < 0;
    const OverlayMesh& mesh = source ? donor_ : target_;
    const Part& part = source ? segment.source : segment.target;
    append_curve(mesh.edge(part.edge), part, origin,
                 (pd * mesh.degree + 2 * mesh.degree - 2) / 2 + 1, boundary_);
  }
  pad(boundary_);
  const FitFrame frame = fit_frame(boundary_);
  if (!(frame.half[0] > 0.0 && frame.half[1] > 0.0)) {
    for (std::size_t c = 0; c < mass.size(); ++c) mass[c] = donor_of(d).mean[c] * area;
    return true;
  }
  const FitTable& table = fit_table(pd);
  const auto nc = static_cast<std::size_t>(g_->components);
  reserve(table, nc, pd);
  for (std::size_t q = 0; q < table.padded; ++q) {
    x_[q] = origin[0] + frame.centre[0] + frame.half[0] * table.x[q];
    y_[q] = origin[1] + frame.centre[1] + frame.half[1] * table.y[q];
  }
  donor_places(d, table.padded);
  if (!is_tame(pd, table.padded, du_.data(), dv_.data())) return false;
  fit_values(pd, g_->components, g_->donor_scaled(d).data(), donor_of(d).mean.data(), table.padded,
             du_.data(), dv_.data(), values_.data());
  fit_interpolate(table, g_->components, values_.data(), terms_.data());
  fit_moments(pd, boundary_, frame, moments_.data());
  const std::size_t stride = fit_stride(pd);
  for (std::size_t c = 0; c < mass.size(); ++c) {
    const double* term = terms_.data() + c * table.terms;
    double sum = 0.0;
    for (int b = 0; b <= pd; ++b)
      for (int a = 0; a <= pd - b; ++a, ++term)
        sum += *term * moments_[static_cast<std::size_t>(b) * stride + static_cast<std::size_t>(a)];
    mass[c] = donor_of(d).mean[c] * area + sum * frame.half[0] * frame.half[1];
  }
  return true;
}

void PairFit::take(double* product, double* basis) {
  if (!any_) return;
  any_ = false;
  const int p = g_->target_space->degree(ElementId(t_)), k = target_degree_;
  // The Jacobian as a polynomial in the target's coordinates.
  const int e = k - p;
  std::vector<double>& det = terms_;
  if (e == 0) {
    det.assign(lanes, target_map_.x[1] * target_map_.y[2] - target_map_.x[2] * target_map_.y[1]);
  } else {
    const FitTable& table = fit_table(e);
    reserve(table, 1, 0);
    for (std::size_t q = 0; q < table.padded; ++q) {
      u_[q] = centre_[0] + reference_half * table.x[q];
      v_[q] = centre_[1] + reference_half * table.y[q];
    }
    fit_map(target_map_, table.padded / lanes, u_.data(), v_.data(), x_.data(), y_.data(),
            det_.data());
    fit_interpolate(table, 1, det_.data(), det.data());
    double scale = 1.0;
    for (int total = 0; total <= e; ++total) {
      for (int b = 0; b <= total; ++b)
        det[static_cast<std::size_t>(bernstein::triangle_index(e, total - b, b))] *= scale;
      scale /= reference_half;
    }
  }
  const std::size_t rows = fit_rows(k), stride = fit_stride(k);
  const auto nc = static_cast<std::size_t>(g_->components);
  const auto size = static_cast<std::size_t>(bernstein::triangle_size(p));
  const std::vector<double>& matrix = power_matrix(p);
  std::array<double, static_cast<std::size_t>(bernstein::triangle_size(max_power_degree))> moments;
  for (std::size_t c = 0; c <= nc; ++c) {
    double* sums = sums_.data() + c * rows;
    std::size_t n = 0;
    for (int b = 0; b <= p; ++b) {
      for (int a = 0; a <= p - b; ++a, ++n) {
        double sum = 0.0;
        std::size_t term = 0;
        for (int f = 0; f <= e; ++f) {
          const double* row = sums + static_cast<std::size_t>(b + f) * stride + a;
          for (int h = 0; h <= e - f; ++h, ++term) sum += det[term] * row[h];
        }
        moments[n] = sum;
      }
    }
    std::fill(sums, sums + rows, 0.0);
    // What rounding leaves here the mass matrix's inverse makes larger, unlike that of the moments.
    for (n = 0; n < size; ++n) {
      const double sum =
          dot(std::span(matrix).subspan(n * size, size), std::span(moments).first(size));
      if (c == nc)
        basis[n] += sum;
      else
        product[n * nc + c] += sum;
    }
  }
}

}  // namespace bezel::detail
