#include "bezel/transfer/group.hpp"

#include <algorithm>
#include <cmath>

#include "bezel/base/parallel.hpp"
#include "bezel/bernstein/fixed_size.hpp"
#include "bezel/transfer/accumulate.hpp"
#include "bezel/transfer/moments.hpp"
#include "bezel/transfer/piece_batch.hpp"
#include "bezel/transfer/power_batch.hpp"

namespace bezel::detail {
namespace {

/// Coefficients that differ by less than this fraction are equal up to rounding.
constexpr double equal_rounding = 0x1p-49;

constexpr std::size_t task_size = 512;  // elements

/// Calls body(e) for all elements.
template <class Body>
void for_blocks(std::size_t elements, int threads, const Body& body) {
  parallel_for((elements + task_size - 1) / task_size,
               [&](std::size_t b) {
                 for (std::size_t e = b * task_size; e < std::min(elements, (b + 1) * task_size);
                      ++e)
                   body(e);
               },
               threads);
}

constexpr auto most_powers = static_cast<std::size_t>(bernstein::triangle_size(max_moment_degree));

/// A row of `fixed` (0: of `size`) numbers times the matrix, as a column of nc components.
template <std::size_t fixed>
void multiply_row(std::size_t size, std::size_t nc, const double* matrix, const double* from,
                  double* to) {
  const std::size_t n = fixed > 0 ? fixed : size;
  std::array<double, (fixed > 0 ? fixed : most_powers)> sum{};
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t m = 0; m < n; ++m) sum[m] += from[i] * matrix[i * n + m];
  for (std::size_t m = 0; m < n; ++m) to[m * nc] = sum[m];
}

/// The powers of some components on some elements of one degree.
void block_powers(int degree, const field_detail::SurveyBlock& block, std::size_t nc, double* to) {
  const std::size_t elements = block.to - block.from;
  if (block.width == lanes) return powers_of(degree, elements, block.c, block.count, nc, to);
  const auto factors = multinomials(degree);
  const double* c = block.c;
  bernstein::with_triangle_size(factors.size(), [&](auto fixed) {
    const double* const matrix = power_matrix(degree).data();
    const std::size_t size = fixed() > 0 ? fixed() : factors.size();
    std::array<double, most_powers> scaled;
    for (std::size_t e = 0; e < elements; ++e, c += size, to += size * nc) {
      for (std::size_t n = 0; n < size; ++n) scaled[n] = c[n] * factors[n];
      multiply_row<fixed()>(size, nc, matrix, scaled.data(), to);
    }
  });
}
static_assert(field_detail::survey_width == lanes);

/// Appends `own` columns of some rows, `stride` apart, side by side.
void append_columns(const double* from, std::size_t stride, std::size_t rows, std::size_t own,
                    std::vector<double>& buffer, std::vector<double>& to) {
  buffer.resize(rows * own);
  if (own == 1) {
    for (std::size_t n = 0; n < rows; ++n) buffer[n] = from[n * stride];
  } else {
    for (std::size_t n = 0; n < rows; ++n) std::copy_n(from + n * stride, own, &buffer[n * own]);
  }
  to.insert(to.end(), buffer.begin(), buffer.end());
}

/// One element's coefficients from number `begin` on, times the factors, one column after the
/// other.
void scale_columns(std::span<const field_detail::Column> columns, std::size_t begin,
                   std::span<const double> factors, double* to) {
  for (const field_detail::Column& column : columns) {
    const double* from = column.first + begin * column.stride;
    for (std::size_t n = 0; n < factors.size(); ++n) to[n] = from[n * column.stride] * factors[n];
    to += factors.size();
  }
}

}  // namespace

Frame affine_frame(const std::array<Vec2, 3>& p) {
  Frame frame;
  const Vec2 a = p[1] - p[0];
  const Vec2 b = p[2] - p[0];
  const double det = cross(a, b);
  frame.gradient[1] = Vec2{{b[1] / det, -b[0] / det}};
  frame.gradient[2] = Vec2{{-a[1] / det, a[0] / det}};
  frame.gradient[0] = -(frame.gradient[1] + frame.gradient[2]);
  frame.centre = p[0] + (a + b) * (1.0 / 3.0);
  return frame;
}

Group::Group(const OverlayMesh& donor, const OverlayMesh& target,
             std::span<const Field* const> fields, std::shared_ptr<const Space> target_space_in,
             int threads)
    : donor_space(fields.front()->space_ptr()),
      target_space(std::move(target_space_in)),
      components(static_cast<int>(field_detail::component_count(fields))),
      donor_degree{donor_space->highest_degree(), donor_space->uniform_degree()},
      donor_mapped(donor_space->basis() == Basis::reference && donor.degree > 1),
      target_mapped(target_space->basis() == Basis::reference && target.degree > 1) {
  make_frames(donor, target, threads);
  const auto nc = static_cast<std::size_t>(components);
  fields_ = field_detail::columns_of(fields);
  donor_measures = std::make_shared<field_detail::SpaceMeasures>(donor_space, threads);
  const field_detail::SurveyAim aim{donor_measures->basis_integrals(), &donor_measures->absolute(),
                                    &donor_measures->ranges()};
  out.resize(target_space->coefficient_count() * nc);
  if (by_powers()) {
    powers.resize(donor_space->coefficient_count() * nc + batch_padding);
    std::fill(powers.end() - batch_padding, powers.end(), 0.0);
  }
  donor_survey = field_detail::survey(
      *donor_space, fields_, aim, threads, [&](const field_detail::SurveyBlock& block) {
        if (!powers.empty())
          block_powers(
              donor_degree.uniform, block, nc,
              powers.data() + donor_space->offset(ElementId(block.from)) * nc + block.first);
      });
  donor_mass = std::move(donor_survey.integrals);
  if (by_powers()) return;
  scaled_.resize(donor_space->coefficient_count() * nc);
  for_blocks(donor.element_count(), threads, [&](std::size_t e) {
    const std::size_t begin = donor_space->offset(ElementId(e));
    scale_columns(fields_, begin, multinomials(donor_space->degree(ElementId(e))),
                  scaled_.data() + begin * nc);
  });
  make_powers(donor.element_count(), threads);
}

bool Group::by_powers() const {
  const int degree = donor_degree.uniform;
  return !donor_mapped && !target_mapped && degree >= 0 && degree <= max_moment_degree &&
         degree == target_space->uniform_degree();
}

Group::Group(const OverlayMesh& donor, const OverlayMesh& target,
             std::shared_ptr<const Space> donor_space_in,
             std::shared_ptr<const Space> target_space_in, int components_in,
             DonorDegree donor_degree_in, std::span<const double> scaled_in,
             std::vector<double> donor_mass_in, int threads)
    : donor_space(std::move(donor_space_in)),
      target_space(std::move(target_space_in)),
      components(components_in),
      donor_degree(donor_degree_in),
      donor_mapped(donor_space->basis() == Basis::reference && donor.degree > 1),
      target_mapped(target_space->basis() == Basis::reference && target.degree > 1),
      donor_mass(std::move(donor_mass_in)),
      scaled_(scaled_in.begin(), scaled_in.end()) {
  make_frames(donor, target, threads);
  out.resize(target_space->coefficient_count() * static_cast<std::size_t>(components));
  make_powers(donor.element_count(), threads);
}

void Group::make_powers(std::size_t elements, int threads) {
  const auto nc = static_cast<std::size_t>(components);
  if (donor_mapped || target_mapped) return;
  powers.resize(scaled_.size() + batch_padding);
  std::fill(powers.end() - batch_padding, powers.end(), 0.0);
  const auto of_elements = [&](std::size_t from, std::size_t to, int degree) {
    const auto size = static_cast<std::size_t>(bernstein::triangle_size(degree));
    const std::size_t begin = donor_space->offset(ElementId(from)) * nc;
    bernstein::with_triangle_size(size, [&](auto fixed) {
      const double* const matrix = power_matrix(degree).data();
      const double* row = scaled_.data() + begin;
      double* to_row = powers.data() + begin;
      for (std::size_t e = from; e < to; ++e, to_row += size * nc)
        for (std::size_t c = 0; c < nc; ++c, row += size)
          multiply_row<fixed()>(size, nc, matrix, row, to_row + c);
    });
  };
  const int uniform = donor_degree.uniform;
  parallel_for((elements + task_size - 1) / task_size,
               [&](std::size_t b) {
                 const std::size_t begin = b * task_size,
                                   end = std::min(elements, begin + task_size);
                 const std::size_t step = uniform >= 0 ? end - begin : 1;
                 for (std::size_t e = begin; e < end; e += step) {
                   const int degree = donor_space->degree(ElementId(e));
                   if (degree <= max_moment_degree) of_elements(e, e + step, degree);
                 }
               },
               threads);
}

Group::Group(const OverlayMesh& donor, const OverlayMesh& target,
             std::shared_ptr<const Space> donor_space_in,
             std::shared_ptr<const Space> target_space_in, DonorDegree degree, int threads)
    : donor_space(std::move(donor_space_in)),
      target_space(std::move(target_space_in)),
      components(bernstein::triangle_size(degree.highest)),
      donor_degree(degree),
      donor_mapped(donor_space->basis() == Basis::reference && donor.degree > 1),
      target_mapped(target_space->basis() == Basis::reference && target.degree > 1) {
  make_frames(donor, target, threads);
  const auto nc = static_cast<std::size_t>(components);
  for (int d = 0; d <= donor_degree.highest; ++d) {
    scaled_offset_.push_back(scaled_.size());
    const auto factors = multinomials(d);
    for (std::size_t c = 0; c < nc; ++c) {
      for (std::size_t n = 0; n < factors.size(); ++n) scaled_.push_back(n == c ? factors[n] : 0.0);
    }
  }
  const std::vector<double> integrals = field_detail::basis_integrals(*donor_space, threads);
  donor_mass.assign(donor.element_count() * nc, 0.0);
  for (std::size_t e = 0; e < donor.element_count(); ++e) {
    const ElementId id(e);
    const auto size = static_cast<std::size_t>(bernstein::triangle_size(donor_space->degree(id)));
    std::copy_n(integrals.begin() + static_cast<std::ptrdiff_t>(donor_space->offset(id)), size,
                donor_mass.begin() + static_cast<std::ptrdiff_t>(e * nc));
  }
}

void Group::make_frames(const OverlayMesh& donor, const OverlayMesh& target, int threads) {
  // Which frame an element gets depends on nothing but the element: so parts of meshes give the
  // bits of the whole.
  const auto of_elements = [&](const OverlayMesh& mesh, const Space& space,
                               std::vector<Frame>& made) -> std::span<const Frame> {
    if (space.basis() == Basis::physical && (mesh.degree > 1 || space.has_own_frames()))
      return space.frames();
    made.resize(mesh.element_count());
    for_blocks(made.size(), threads, [&](std::size_t e) {
      made[e] = space.is_own_frame(ElementId(e))
                    ? space.frame(ElementId(e))
                    : affine_frame(mesh.corners(static_cast<std::int32_t>(e)));
    });
    return made;
  };
  // A donor's polynomials stay on their frames.
  if (!donor_mapped) {
    donor_frame = donor_space->basis() == Basis::physical
                      ? donor_space->frames()
                      : of_elements(donor, *donor_space, made_donor_frame_);
  }
  // A target's may stay on the triangle they are computed on when the space's frame is that one.
  if (!target_mapped) target_frame = of_elements(target, *target_space, made_target_frame_);
}

ScaledCoefficients Group::donor_scaled(std::int32_t e) const {
  const ElementId id(e);
  const auto nc = static_cast<std::size_t>(components);
  const int degree = donor_space->degree(id);
  const auto size = static_cast<std::size_t>(bernstein::triangle_size(degree));
  const std::size_t begin = donor_space->offset(id);
  if (scaled_.empty()) {
    std::vector<double> made(size * nc);
    scale_columns(fields_, begin, multinomials(degree), made.data());
    return ScaledCoefficients(std::move(made));
  }
  const std::size_t place =
      of_basis() ? scaled_offset_[static_cast<std::size_t>(degree)] : begin * nc;
  return ScaledCoefficients(std::span<const double>(scaled_).subspan(place, size * nc));
}

void Group::constants_of(const OverlayMesh& donor, std::int32_t e,
                         std::span<double> constants) const {
  const auto d = static_cast<std::size_t>(e);
  const auto factors = multinomials(donor_space->degree(ElementId(e)));
  const ScaledCoefficients scaled = donor_scaled(e);
  const double* own = scaled.data();
  for (std::size_t c = 0; c < constants.size(); ++c, own += factors.size()) {
    bool equal = true;
    for (std::size_t n = 0; n < factors.size(); ++n) {
      const double all = own[0] * factors[n];
      equal = equal && std::abs(own[n] - all) <= equal_rounding * std::abs(all);
    }
    constants[c] = equal ? own[0] : donor_mass[d * constants.size() + c] / donor.element_area[d];
  }
}

std::span<double> Group::target_out(std::int32_t e) {
  const ElementId id(e);
  const auto nc = static_cast<std::size_t>(components);
  const auto size = static_cast<std::size_t>(bernstein::triangle_size(target_space->degree(id)));
  return {out.data() + target_space->offset(id) * nc, size * nc};
}

void Group::drop_donor() {
  scaled_ = {};
  fields_.clear();
  powers = {};
}

std::vector<std::vector<double>> take_fields(Group& g, std::span<const std::size_t> components,
                                             const field_detail::SurveyAim& aim,
                                             field_detail::Survey& survey, int threads) {
  std::vector<std::vector<double>> parts(components.size());
  const Space& space = *g.target_space;
  const bool look = !aim.basis_integrals.empty();
  if (components.size() == 1) {
    parts[0] = std::move(g.out);
    if (!look) return parts;
    std::vector<field_detail::Column> columns;
    for (std::size_t c = 0; c < components[0]; ++c)
      columns.push_back({parts[0].data() + c, components[0]});
    survey = field_detail::survey(space, columns, aim, threads);
    return parts;
  }
  const std::size_t rows = space.coefficient_count(), elements = space.mesh()->element_count();
  const auto all = static_cast<std::size_t>(g.components);
  if (look) survey = field_detail::make_survey(space, all, aim);
  std::vector<std::size_t> first(components.size() + 1, 0);
  for (std::size_t m = 0; m < components.size(); ++m) first[m + 1] = first[m] + components[m];
  // Some fields a task, some rows for one field after the other: what lies side by side is read
  // once, and what is written need not be set to 0 before.
  constexpr std::size_t some_fields = 8;
  parallel_for(
      (components.size() + some_fields - 1) / some_fields,
      [&](std::size_t task) {
        const std::size_t begin = task * some_fields,
                          end = std::min(begin + some_fields, components.size());
        for (std::size_t m = begin; m < end; ++m) parts[m].reserve(rows * components[m]);
        const bool scalars = first[end] - first[begin] == end - begin;
        std::vector<double> buffer, column;
        field_detail::SurveyRoom room;
        for (std::size_t e = 0; e < elements; e += field_detail::survey_block) {
          const std::size_t last = std::min(e + field_detail::survey_block, elements);
          const std::size_t row = space.offset(ElementId(e));
          const std::size_t count = (last < elements ? space.offset(ElementId(last)) : rows) - row;
          const double* const block = g.out.data() + row * all;
          for (std::size_t c = first[begin]; (look || scalars) && c < first[end]; c += lanes) {
            const std::size_t some = std::min(lanes, first[end] - c);
            buffer.resize(count * lanes);
            field_detail::copy_rows(count, some, block + c, all, buffer.data(), lanes);
            if (look)
              field_detail::look(space, aim, {e, last, c, some, lanes, buffer.data()}, survey,
                                 room);
            if (scalars) {
              for (std::size_t k = 0; k < some; ++k)
                append_columns(buffer.data() + k, lanes, count, 1, column, parts[begin + k]);
            }
          }
          for (std::size_t m = begin; m < end && !scalars; ++m)
            append_columns(block + first[m], all, count, components[m], column, parts[m]);
        }
      },
      threads);
  return parts;
}

std::array<double, 2> donor_place(const Group& g, const OverlayMesh& donor, std::int32_t d,
                                  const Vec2& x, std::array<double, 3>& warm, bool& have_warm) {
  if (!g.donor_mapped) {
    const auto lambda = g.donor_frame[static_cast<std::size_t>(d)].lambda(x);
    return {lambda[1], lambda[2]};
  }
  std::array<double, 3> lambda = warm;
  if (invert_map(donor.degree, donor.element(d), x, lambda, have_warm)) {
    warm = lambda;
    have_warm = true;
    return {lambda[1], lambda[2]};
  }
  // Outside the reach of the map (a point far outside a curved element): the nearest corner
  // direction.
  have_warm = false;
  const auto corners = donor.corners(d);
  const auto guess = affine_frame(corners).lambda(x);
  const double low = std::min({guess[0], guess[1], guess[2], 0.0});
  const double total = 1.0 - 3.0 * low;
  return {(guess[1] - low) / total, (guess[2] - low) / total};
}

}  // namespace bezel::detail
