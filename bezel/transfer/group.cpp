#include "bezel/transfer/group.hpp"

#include <algorithm>
#include <cmath>

#include "bezel/base/parallel.hpp"
#include "bezel/bernstein/fixed_size.hpp"
#include "bezel/field/integrals.hpp"
#include "bezel/transfer/accumulate.hpp"
#include "bezel/transfer/moments.hpp"
#include "bezel/transfer/piece_batch.hpp"

namespace bezel::detail {
namespace {

/// Coefficients that differ by less than this fraction are equal up to rounding.
constexpr double equal_rounding = 0x1p-49;

constexpr std::size_t block = 512;  // elements a task

/// Calls body(e) for all elements.
template <class Body>
void for_blocks(std::size_t elements, int threads, const Body& body) {
  parallel_for((elements + block - 1) / block,
               [&](std::size_t b) {
                 for (std::size_t e = b * block; e < std::min(elements, (b + 1) * block); ++e)
                   body(e);
               },
               threads);
}

/// One component of a donor field: its coefficients are `stride` apart.
struct Column {
  const double* first;
  std::size_t stride;
};

std::vector<Column> columns_of(std::span<const Field* const> fields) {
  std::vector<Column> columns;
  for (const Field* f : fields) {
    const auto own = static_cast<std::size_t>(f->components());
    for (std::size_t c = 0; c < own; ++c) columns.push_back({f->coefficients().data() + c, own});
  }
  return columns;
}

/// Coefficients of one element from number `begin` on, times the factors, one column after the
/// other.
void scale_columns(std::span<const Column> columns, std::size_t begin,
                   std::span<const double> factors, double* to) {
  bernstein::with_triangle_size(factors.size(), [&](auto fixed) {
    const std::size_t size = fixed() > 0 ? fixed() : factors.size();
    for (const Column& column : columns) {
      const double* from = column.first + begin * column.stride;
      if (column.stride == 1) {
        for (std::size_t n = 0; n < size; ++n) to[n] = from[n] * factors[n];
      } else {
        for (std::size_t n = 0; n < size; ++n) to[n] = from[n * column.stride] * factors[n];
      }
      to += size;
    }
  });
}

/// Each of nc rows of `fixed` (0: of `size`) numbers times the matrix, as columns.
template <std::size_t fixed>
void multiply_rows(std::size_t size, std::size_t nc, const double* matrix, const double* from,
                   double* to) {
  constexpr std::size_t room =
      fixed > 0 ? fixed : static_cast<std::size_t>(bernstein::triangle_size(max_moment_degree));
  const std::size_t n = fixed > 0 ? fixed : size;
  for (std::size_t c = 0; c < nc; ++c, from += n) {
    std::array<double, room> sum{};
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t m = 0; m < n; ++m) sum[m] += from[i] * matrix[i * n + m];
    for (std::size_t m = 0; m < n; ++m) to[m * nc + c] = sum[m];
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
  donor_integrals = field_detail::basis_integrals(*donor_space, threads);
  donor_mass = field_detail::element_integrals(fields, donor_integrals, threads);
  scaled.resize(donor_space->coefficient_count() * nc);
  const std::vector<Column> columns = columns_of(fields);
  if (nc == 1 && donor_degree.highest <= 1) {
    // The factors are 1.
    const std::span<const double> all = fields.front()->coefficients();
    std::copy(all.begin(), all.end(), scaled.begin());
  } else {
    for_blocks(donor.element_count(), threads, [&](std::size_t e) {
      const std::size_t begin = donor_space->offset(ElementId(e));
      scale_columns(columns, begin, multinomials(donor_space->degree(ElementId(e))),
                    scaled.data() + begin * nc);
    });
  }
  out.resize(target_space->coefficient_count() * nc);
  make_powers(donor.element_count(), threads);
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
      scaled(scaled_in.begin(), scaled_in.end()),
      donor_mass(std::move(donor_mass_in)) {
  make_frames(donor, target, threads);
  out.resize(target_space->coefficient_count() * static_cast<std::size_t>(components));
  make_powers(donor.element_count(), threads);
}

void Group::make_powers(std::size_t elements, int threads) {
  const auto nc = static_cast<std::size_t>(components);
  if (donor_mapped || target_mapped) return;
  powers.resize(scaled.size() + batch_padding);
  std::fill(powers.end() - batch_padding, powers.end(), 0.0);
  const auto of_elements = [&](std::size_t from, std::size_t to, int degree) {
    const auto size = static_cast<std::size_t>(bernstein::triangle_size(degree));
    const std::size_t begin = donor_space->offset(ElementId(from)) * nc;
    bernstein::with_triangle_size(size, [&](auto fixed) {
      const double* const matrix = power_matrix(degree).data();
      const double* row = scaled.data() + begin;
      double* to_row = powers.data() + begin;
      for (std::size_t e = from; e < to; ++e, row += size * nc, to_row += size * nc)
        multiply_rows<fixed()>(size, nc, matrix, row, to_row);
    });
  };
  const int uniform = donor_degree.uniform;
  parallel_for((elements + block - 1) / block,
               [&](std::size_t b) {
                 const std::size_t begin = b * block, end = std::min(elements, begin + block);
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
    scaled_offset_.push_back(scaled.size());
    const auto factors = multinomials(d);
    for (std::size_t c = 0; c < nc; ++c) {
      for (std::size_t n = 0; n < factors.size(); ++n) scaled.push_back(n == c ? factors[n] : 0.0);
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

std::span<const double> Group::donor_scaled(std::int32_t e) const {
  const ElementId id(e);
  const auto nc = static_cast<std::size_t>(components);
  const int degree = donor_space->degree(id);
  const auto size = static_cast<std::size_t>(bernstein::triangle_size(degree));
  if (!scaled_offset_.empty())
    return {scaled.data() + scaled_offset_[static_cast<std::size_t>(degree)], size * nc};
  return {scaled.data() + donor_space->offset(id) * nc, size * nc};
}

double Group::constant_of(const OverlayMesh& donor, std::int32_t e, std::size_t component) const {
  const auto d = static_cast<std::size_t>(e);
  const auto nc = static_cast<std::size_t>(components);
  const auto factors = multinomials(donor_space->degree(ElementId(e)));
  const auto own = donor_scaled(e).subspan(component * factors.size(), factors.size());
  bool equal = true;
  for (std::size_t n = 0; n < factors.size(); ++n) {
    const double all = own[0] * factors[n];
    equal = equal && std::abs(own[n] - all) <= equal_rounding * std::abs(all);
  }
  return equal ? own[0] : donor_mass[d * nc + component] / donor.element_area[d];
}

std::span<double> Group::target_out(std::int32_t e) {
  const ElementId id(e);
  const auto nc = static_cast<std::size_t>(components);
  const auto size = static_cast<std::size_t>(bernstein::triangle_size(target_space->degree(id)));
  return {out.data() + target_space->offset(id) * nc, size * nc};
}

void Group::drop_donor() {
  scaled = {};
  powers = {};
}

std::vector<std::vector<double>> take_fields(Group& g, std::span<const std::size_t> components,
                                             int threads) {
  std::vector<std::vector<double>> parts(components.size());
  if (components.size() == 1) {
    parts[0] = std::move(g.out);
    return parts;
  }
  const std::size_t rows = g.target_space->coefficient_count();
  const auto all = static_cast<std::size_t>(g.components);
  std::vector<std::size_t> first(components.size(), 0);
  for (std::size_t m = 1; m < first.size(); ++m) first[m] = first[m - 1] + components[m - 1];
  // Some fields a task, some rows for one field after the other: what lies side by side is read
  // once, and what is written need not be set to 0 before.
  constexpr std::size_t some_rows = 64, some_fields = 8;
  parallel_for(
      (components.size() + some_fields - 1) / some_fields,
      [&](std::size_t task) {
        const std::size_t begin = task * some_fields,
                          end = std::min(begin + some_fields, components.size());
        for (std::size_t m = begin; m < end; ++m) parts[m].reserve(rows * components[m]);
        std::array<double, some_rows* static_cast<std::size_t>(Field::max_components)> buffer;
        for (std::size_t r = 0; r < rows; r += some_rows) {
          const std::size_t count = std::min(some_rows, rows - r);
          for (std::size_t m = begin; m < end; ++m) {
            const std::size_t own = components[m];
            const double* from = g.out.data() + r * all + first[m];
            if (own == 1) {
              for (std::size_t n = 0; n < count; ++n) buffer[n] = from[n * all];
            } else {
              for (std::size_t n = 0; n < count; ++n)
                for (std::size_t c = 0; c < own; ++c) buffer[n * own + c] = from[n * all + c];
            }
            parts[m].insert(parts[m].end(), buffer.data(), buffer.data() + count * own);
          }
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
