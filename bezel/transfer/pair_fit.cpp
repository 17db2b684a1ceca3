#include "bezel/transfer/pair_fit.hpp"
#include "bezel/transfer/piece_batch.hpp"

#include <algorithm>
#include <cmath>

#include "bezel/bernstein/index.hpp"
#include "bezel/numeric/sum.hpp"
#include "bezel/transfer/moments.hpp"

namespace bezel::detail {
namespace {

/// As pulled_extra, where nothing else is inexact.
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
/// Highest degree of fields that are not mapped: above, quadrature is more accurate.
constexpr int max_plane_degree = 5;

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

/// The integral of an interpolant over a region, from its terms and the region's moments.
double integral_of(int degree, const double* term, const double* moments, std::size_t stride) {
  double sum = 0.0;
  for (int b = 0; b <= degree; ++b)
    for (int a = 0; a <= degree - b; ++a, ++term)
      sum += *term * moments[static_cast<std::size_t>(b) * stride + static_cast<std::size_t>(a)];
  return sum;
}

}  // namespace

PairFit::PairFit(const OverlayMesh& donor, const OverlayMesh& target, std::size_t groups)
    : donor_(donor), target_(target), donors_(donor, target, groups) {}

bool PairFit::can(const Group& g, const OverlayMesh& donor, const OverlayMesh& target) {
  const int pd = g.donor_degree.highest;
  const int pt = g.target_space->highest_degree();
  if (!g.donor_mapped && !g.target_mapped && std::max(pd, pt) > max_plane_degree) return false;
  const int k = target_degree(g, target, pt);
  const int m = fit_degree(g, target, pd);
  return m <= max_fit_degree && k < static_cast<int>(2 * lanes) && m + k <= max_fit_moments &&
         (!g.donor_mapped || FitDonors::mass_degree(donor, pd) <= max_fit_degree);
}

void PairFit::begin(std::size_t i, const Group& g, std::int32_t t,
                    std::span<const Segment> segments, bool around_a_constant) {
  work_ = Work{};
  work_.group = i;
  work_.fields = &g;
  work_.element = t;
  work_.segments = segments;
  work_.degree = target_degree(g, target_, g.target_space->degree(ElementId(t)));
  make_target_map();
  sums_.assign(static_cast<std::size_t>(g.components + 1) * fit_rows(work_.degree), 0.0);
  work_.constant.resize(static_cast<std::size_t>(g.components), 0.0);
  if (around_a_constant) choose_constants();
  make_target_points();
}

void PairFit::make_target_map() {
  const Group& g = *work_.fields;
  if (g.target_mapped) {
    target_map_.set(target_.degree, target_.element(work_.element));
    work_.centre = {1.0 / 3.0, 1.0 / 3.0};
    return;
  }
  const TargetPlace place = place_of(g.target_frame[static_cast<std::size_t>(work_.element)]);
  target_map_.set_affine(place.centre, place.along_first, place.along_second);
}

// Of donors, so that a constant leaves nothing to integrate.
void PairFit::choose_constants() {
  SmallestConstants constants(work_.constant);
  std::int32_t last = exterior;
  for (const Segment& segment : work_.segments) {
    const std::int32_t d = segment.donor;
    if (d == exterior || d == last) continue;
    constants.take(donor_of(d).mean.data());
    last = d;
  }
}

void PairFit::make_target_points() {
  own_.clear();
  pulled_.clear();
  work_.runs.resize(work_.segments.size());
  if (seen_.size() < donor_.edge_count()) seen_.resize(donor_.edge_count());
  ++stamp_;
  // Degrees that interpolation adds are small and need no exact rule.
  const Group& g = *work_.fields;
  const int pd = g.donor_degree.highest;
  const int degree =
      work_.degree + (g.donor_mapped && pd > 0 ? pd + 1 : fit_degree(g, target_, pd));
  for (std::size_t i = 0; i < work_.segments.size(); ++i) work_.runs[i] = append_segment(i, degree);
  work_.placed = true;
  if (pulled_.count > 0) place_in_target();
}

PairFit::Run PairFit::append_segment(std::size_t i, int degree) {
  const Group& g = *work_.fields;
  const Segment& segment = work_.segments[i];
  const bool mapped = g.target_mapped;
  if (segment.target.edge >= 0 && mapped) {
    const std::size_t first = own_.count;
    points_.append_side(target_, work_.element, segment.target, degree / 2 + 1, own_);
    return {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(own_.count - first),
            false, false};
  }
  const bool source = segment.target.edge < 0;
  if (source) {
    // The donor on the other side has the same piece, reversed.
    Seen& seen = seen_[static_cast<std::size_t>(segment.source.edge)];
    if (seen.stamp == stamp_) {
      const Part& other = work_.segments[seen.segment].source;
      if (other.from == segment.source.to && other.to == segment.source.from) {
        Run run = work_.runs[seen.segment];
        run.reversed = true;
        return run;
      }
    }
    seen = {stamp_, static_cast<std::uint32_t>(i)};
  }
  const OverlayMesh& mesh = source ? donor_ : target_;
  const Part& part = source ? segment.source : segment.target;
  const int extra = g.donor_mapped ? pulled_extra : pulled_extra_plane;
  const int points =
      mapped ? degree / 2 + 1 + extra : (degree * mesh.degree + 2 * mesh.degree - 2) / 2 + 1;
  const Vec2 origin = mapped ? Vec2{} : target_map_.base;
  const std::size_t first =
      points_.append_curve(mesh.edge(part.edge), part, origin, points, pulled_);
  return {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(pulled_.count - first),
          true, false};
}

void PairFit::place_in_target() {
  const Group& g = *work_.fields;
  pad(pulled_);
  const std::size_t whole = padded_to_lanes(pulled_.count);
  if (g.target_mapped) {
    work_.placed =
        fit_invert(target_map_, whole / lanes, pulled_.x.data(), pulled_.y.data(), pulled_.x.data(),
                   pulled_.y.data(), pulled_.dx.data(), pulled_.dy.data()) &&
        in_reference_triangle(pulled_);
    return;
  }
  const Frame& frame = g.target_frame[static_cast<std::size_t>(work_.element)];
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
    const Run& run = work_.runs[i];
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

// Fills in du, dv from the points x, y in the plane.
bool PairFit::donor_places(std::int32_t d, std::size_t padded) {
  FitRoom& room = room_;
  if (work_.fields->donor_mapped)
    return fit_invert(donor_of(d).map, padded / lanes, room.x.data(), room.y.data(), room.du.data(),
                      room.dv.data(), nullptr, nullptr);
  const Frame& frame = work_.fields->donor_frame[static_cast<std::size_t>(d)];
  const Vec2 &a = frame.gradient[1], &b = frame.gradient[2];
  for (std::size_t q = 0; q < padded; ++q) {
    const double x = room.x[q] - frame.centre[0], y = room.y[q] - frame.centre[1];
    room.du[q] = 1.0 / 3.0 + (a[0] * x + a[1] * y);
    room.dv[q] = 1.0 / 3.0 + (b[0] * x + b[1] * y);
  }
  return true;
}

// The points of a table in a frame and their places in the donor; false when degree m is not
// enough for polynomials of degree p there.
bool PairFit::place_points(std::int32_t d, int m, int p, const FitFrame& frame) {
  const FitTable& table = fit_table(m);
  FitRoom& room = room_;
  room.reserve(table, static_cast<std::size_t>(work_.fields->components), m + work_.degree);
  for (std::size_t q = 0; q < table.padded; ++q) {
    room.u[q] = frame.centre[0] + frame.half[0] * table.x[q];
    room.v[q] = frame.centre[1] + frame.half[1] * table.y[q];
  }
  fit_map(target_map_, table.padded / lanes, room.u.data(), room.v.data(), room.x.data(),
          room.y.data(), nullptr);
  if (!donor_places(d, table.padded) || !is_tame(p, table.padded, room.du.data(), room.dv.data()))
    return false;
  if (!work_.fields->donor_mapped || p == 0) return true;
  const auto tails = fit_tails(table, room.du.data(), room.dv.data());
  const auto largest = largest_tails(m, p);
  return tails[0] <= largest[0] && tails[1] <= largest[1];
}

bool PairFit::add(std::int32_t d, std::size_t begin, std::size_t end, double area,
                  std::span<double> mass) {
  const Group& g = *work_.fields;
  const int pd = g.donor_space->degree(ElementId(d));
  const std::span<const Segment> run = work_.segments.subspan(begin, end - begin);
  const FitDonor& donor = donor_of(d);
  if (g.donor_mapped)
    donors_.integrate(donor, run, area, {}, mass);
  else if (g.target_mapped && !plane_mass(d, run, area, mass))
    return false;
  if (!work_.placed) return false;
  collect(begin, end);
  FitFrame frame = fit_frame(boundary_);
  for (double& half : frame.half) half = std::max(half, 1e-12);
  int m = fit_degree(g, target_, pd);
  while (!place_points(d, m, pd, frame)) {
    m += more_degrees;
    if (m > max_fit_degree || m + work_.degree > max_fit_moments) return false;
  }
  const FitTable& table = fit_table(m);
  FitRoom& room = room_;
  fit_values(pd, g.components, g.donor_scaled(d).data(), work_.constant.data(), table.padded,
             room.du.data(), room.dv.data(), room.values.data());
  fit_interpolate(table, g.components, room.values.data(), room.terms.data());
  fit_moments(m + work_.degree, boundary_, frame, room.moments.data());
  fit_add(table, work_.degree, g.components, room.terms.data(), room.moments.data(), frame,
          work_.centre, sums_.data());
  work_.any = true;
  if (g.donor_mapped || g.target_mapped) return true;
  const double scale = frame.half[0] * frame.half[1] *
                       (target_map_.x[1] * target_map_.y[2] - target_map_.x[2] * target_map_.y[1]);
  for (std::size_t c = 0; c < mass.size(); ++c) {
    const double sum = integral_of(m, room.terms.data() + c * table.terms, room.moments.data(),
                                   fit_stride(m + work_.degree));
    // Around the donor's mean, so that a constant gives its area exactly.
    const double mean = donor.mean[c];
    mass[c] = mean * area + scale * (sum - (mean - work_.constant[c]) * room.moments[0]);
  }
  return true;
}

void PairFit::mass_of(std::int32_t d, std::size_t begin, std::size_t end, double area,
                      std::span<const std::array<Vec2, 2>> bridges, std::span<double> mass) {
  donors_.integrate(donor_of(d), work_.segments.subspan(begin, end - begin), area, bridges, mass);
}

// Exactly, in the plane.
bool PairFit::plane_mass(std::int32_t d, std::span<const Segment> run, double area,
                         std::span<double> mass) {
  const Group& g = *work_.fields;
  const int pd = g.donor_space->degree(ElementId(d));
  const Vec2 origin = target_map_.base;
  boundary_.clear();
  for (const Segment& segment : run) {
    const bool source = segment.target.edge < 0;
    const OverlayMesh& mesh = source ? donor_ : target_;
    const Part& part = source ? segment.source : segment.target;
    points_.append_curve(mesh.edge(part.edge), part, origin,
                         (pd * mesh.degree + 2 * mesh.degree - 2) / 2 + 1, boundary_);
  }
  pad(boundary_);
  const std::vector<double>& mean = donor_of(d).mean;
  const FitFrame frame = fit_frame(boundary_);
  if (!(frame.half[0] > 0.0 && frame.half[1] > 0.0)) {
    for (std::size_t c = 0; c < mass.size(); ++c) mass[c] = mean[c] * area;
    return true;
  }
  const FitTable& table = fit_table(pd);
  FitRoom& room = room_;
  room.reserve(table, mass.size(), pd);
  for (std::size_t q = 0; q < table.padded; ++q) {
    room.x[q] = origin[0] + frame.centre[0] + frame.half[0] * table.x[q];
    room.y[q] = origin[1] + frame.centre[1] + frame.half[1] * table.y[q];
  }
  donor_places(d, table.padded);
  if (!is_tame(pd, table.padded, room.du.data(), room.dv.data())) return false;
  fit_values(pd, g.components, g.donor_scaled(d).data(), mean.data(), table.padded, room.du.data(),
             room.dv.data(), room.values.data());
  fit_interpolate(table, g.components, room.values.data(), room.terms.data());
  fit_moments(pd, boundary_, frame, room.moments.data());
  for (std::size_t c = 0; c < mass.size(); ++c) {
    const double sum =
        integral_of(pd, room.terms.data() + c * table.terms, room.moments.data(), fit_stride(pd));
    mass[c] = mean[c] * area + sum * frame.half[0] * frame.half[1];
  }
  return true;
}

const std::vector<double>& PairFit::target_jacobian(int degree) {
  FitRoom& room = room_;
  std::vector<double>& det = room.terms;
  if (degree == 0) {
    det.assign(lanes, target_map_.x[1] * target_map_.y[2] - target_map_.x[2] * target_map_.y[1]);
    return det;
  }
  const FitTable& table = fit_table(degree);
  room.reserve(table, 1, 0);
  for (std::size_t q = 0; q < table.padded; ++q) {
    room.u[q] = work_.centre[0] + reference_half * table.x[q];
    room.v[q] = work_.centre[1] + reference_half * table.y[q];
  }
  fit_map(target_map_, table.padded / lanes, room.u.data(), room.v.data(), room.x.data(),
          room.y.data(), room.det.data());
  fit_interpolate(table, 1, room.det.data(), det.data());
  double scale = 1.0;
  for (int total = 0; total <= degree; ++total) {
    for (int b = 0; b <= total; ++b)
      det[static_cast<std::size_t>(bernstein::triangle_index(degree, total - b, b))] *= scale;
    scale /= reference_half;
  }
  return det;
}

void PairFit::take(double* product, double* basis) {
  if (!work_.any) return;
  work_.any = false;
  const Group& g = *work_.fields;
  const int p = g.target_space->degree(ElementId(work_.element)), k = work_.degree;
  const int e = k - p;
  const std::vector<double>& det = target_jacobian(e);
  const std::size_t rows = fit_rows(k), stride = fit_stride(k);
  const auto nc = static_cast<std::size_t>(g.components);
  const auto size = static_cast<std::size_t>(bernstein::triangle_size(p));
  const std::vector<double>& matrix = power_matrix(p);
  std::array<double, static_cast<std::size_t>(bernstein::triangle_size(max_power_degree))> moments;
  for (std::size_t c = 0; c <= nc; ++c) {
    double* sums = sums_.data() + c * rows;
    std::size_t n = 0;
    for (int b = 0; b <= p; ++b)
      for (int a = 0; a <= p - b; ++a, ++n)
        moments[n] =
            integral_of(e, det.data(), sums + static_cast<std::size_t>(b) * stride + a, stride);
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
