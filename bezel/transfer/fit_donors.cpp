#include "bezel/transfer/fit_donors.hpp"

#include "bezel/bernstein/triangle_kernel.hpp"
#include "bezel/geometry/curve_kernel.hpp"

namespace bezel::detail {
namespace {

/// Places for donor elements whose maps are kept.
constexpr std::size_t kept_donors = 256;

}  // namespace

void FitRoom::reserve(const FitTable& table, std::size_t components, int degree) {
  const auto grow = [](std::vector<double>& array, std::size_t size) {
    if (array.size() < size) array.resize(size);
  };
  for (std::vector<double>* array : {&u, &v, &x, &y, &du, &dv, &det}) grow(*array, table.padded);
  grow(values, components * table.padded);
  grow(terms, components * table.terms);
  grow(moments, fit_rows(degree) + 2 * lanes);
}

FitDonors::FitDonors(const OverlayMesh& donor, const OverlayMesh& target, std::size_t groups)
    : donor_(donor), target_(target), kept_(groups) {}

const FitDonor& FitDonors::of(std::size_t i, const Group& g, std::int32_t d) {
  std::vector<FitDonor>& kept = kept_[i];
  if (kept.empty()) kept.resize(kept_donors);
  FitDonor& donor = kept[static_cast<std::size_t>(d) % kept_donors];
  if (donor.element == d) return donor;
  donor.element = d;
  donor.mean.resize(static_cast<std::size_t>(g.components));
  g.constants_of(donor_, d, donor.mean);
  if (g.donor_mapped) make_mass(g, donor);
  return donor;
}

void FitDonors::make_mass(const Group& g, FitDonor& donor) {
  const std::int32_t d = donor.element;
  const auto nc = static_cast<std::size_t>(g.components);
  donor.map.set(donor_.degree, donor_.element(d));
  const int pd = g.donor_space->degree(ElementId(d));
  const int degree = donor.degree = mass_degree(donor_, pd);
  const FitTable& table = fit_table(degree);
  room_.reserve(table, nc, degree);
  for (std::size_t q = 0; q < table.padded; ++q) {
    room_.u[q] = 1.0 / 3.0 + reference_half * table.x[q];
    room_.v[q] = 1.0 / 3.0 + reference_half * table.y[q];
  }
  fit_map(donor.map, table.padded / lanes, room_.u.data(), room_.v.data(), room_.x.data(),
          room_.y.data(), room_.det.data());
  fit_values(pd, g.components, g.donor_scaled(d).data(), donor.mean.data(), table.padded,
             room_.u.data(), room_.v.data(), room_.values.data());
  for (std::size_t c = 0; c < nc; ++c)
    for (std::size_t q = 0; q < table.padded; ++q)
      room_.values[c * table.padded + q] *= room_.det[q];
  fit_interpolate(table, g.components, room_.values.data(), room_.terms.data());
  const std::size_t rows = fit_rows(degree), stride = fit_stride(degree);
  donor.mass.assign(nc * rows, 0.0);
  for (std::size_t c = 0; c < nc; ++c) {
    const double* term = room_.terms.data() + c * table.terms;
    for (int b = 0; b <= degree; ++b)
      for (int a = 0; a <= degree - b; ++a, ++term)
        donor.mass[c * rows + static_cast<std::size_t>(b) * stride + static_cast<std::size_t>(a)] =
            reference_half * reference_half * *term;
  }
}

int FitDonors::mass_points(int degree) {
  return degree / 2 + 1 + pulled_extra;
}

// By a rule whose parts cancel between neighbouring target elements: along the donor's own sides
// exact, along a target edge with nodes that both elements beside it have.
void FitDonors::integrate(const FitDonor& donor, std::span<const Segment> run, double area,
                          std::span<const std::array<Vec2, 2>> bridges, std::span<double> mass) {
  const int degree = donor.degree, pulled = mass_points(degree);
  boundary_.clear();
  for (const Segment& segment : run) {
    if (segment.source.edge >= 0) continue;
    points_.append_curve(target_.edge(segment.target.edge), segment.target, Vec2{}, pulled,
                         boundary_);
  }
  if (boundary_.count > 0) {
    pad(boundary_);
    double *x = boundary_.x.data(), *y = boundary_.y.data();
    if (!fit_invert(donor.map, padded_to_lanes(boundary_.count) / lanes, x, y, x, y,
                    boundary_.dx.data(), boundary_.dy.data()) ||
        !in_reference_triangle(boundary_)) {
      boundary_.clear();
      for (const Segment& segment : run)
        if (segment.source.edge < 0) append_one_by_one(donor.element, segment.target, pulled);
    }
  }
  for (const Segment& segment : run)
    if (segment.source.edge >= 0)
      points_.append_side(donor_, donor.element, segment.source, degree / 2 + 1, boundary_);
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
  if (room_.moments.size() < rows) room_.moments.resize(rows);
  fit_moments(degree, boundary_, frame, room_.moments.data());
  for (std::size_t c = 0; c < mass.size(); ++c)
    mass[c] =
        donor.mean[c] * area + fit_dot(degree, donor.mass.data() + c * rows, room_.moments.data());
}

// Where Newton's method from the affine map fails: each point from the one before.
void FitDonors::append_one_by_one(std::int32_t d, const Part& part, int points) {
  const EdgePoints::Rule& line = points_.rule(points);
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

void FitDonors::pull_point(std::int32_t d, const std::array<double, 3>& lambda, const Vec2& step,
                           std::size_t at) {
  const auto map = bernstein::kernel::evaluate_gradient_unchecked<Vec2, double>(
      donor_.degree, donor_.element(d).data(), lambda);
  const double scale = 1.0 / cross(map.du, map.dv);
  boundary_.x[at] = lambda[1];
  boundary_.y[at] = lambda[2];
  boundary_.dx[at] = cross(step, map.dv) * scale;
  boundary_.dy[at] = cross(map.du, step) * scale;
}

}  // namespace bezel::detail
