#include "bezel/transfer/operator.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <vector>

#include "bezel/base/atomic_file.hpp"
#include "bezel/base/parallel.hpp"
#include "bezel/field/integrals.hpp"
#include "bezel/transfer/element_mass.hpp"
#include "bezel/transfer/layout.hpp"
#include "bezel/transfer/limit.hpp"
#include "bezel/transfer/local_bounds.hpp"
#include "bezel/transfer/operator_by.hpp"
#include "bezel/transfer/operator_rows.hpp"
#include "bezel/transfer/report.hpp"

namespace bezel {

using detail::OperatorRows;
using detail::same_layout;

namespace {

/// A target element whose received area is this near to its own is covered.
constexpr double covered = 1e-9;

std::size_t size_on(const Space& space, std::int32_t e) {
  return static_cast<std::size_t>(bernstein::triangle_size(space.degree(ElementId(e))));
}

std::shared_ptr<const Space> broken(const std::shared_ptr<const Space>& space) {
  if (space->continuity() == Continuity::discontinuous) return space;
  return Space::discontinuous(space->mesh(), space->highest_degree(), space->basis());
}

void check(const std::shared_ptr<const Space>& donor,
           const std::shared_ptr<const TriangleMesh>& target, const TransferOptions& options) {
  if (!donor) throw InputError("transfer operator: no donor space given");
  if (!target) throw InputError("transfer operator: no target mesh given");
  if (options.degree < -1 || options.degree > Space::max_degree) {
    throw InputError("transfer operator: degree " + std::to_string(options.degree) +
                     " is not supported, expected 0 to " + std::to_string(Space::max_degree));
  }
  if (options.weight || !options.density.empty()) {
    throw InputError("transfer operator: weights are not supported, expected none");
  }
  if (!detail::is_linear(options)) {
    throw InputError(
        "transfer operator: expected a discontinuous target without bounds that conserves what is "
        "covered");
  }
}

}  // namespace

struct TransferOperator::Impl {
  std::shared_ptr<const Space> donor, target;
  TransferReport report;
  OperatorRows rows;
  std::vector<double> integrals;             // of the target's basis functions
  std::vector<std::int32_t> outside;         // donor elements partly outside the target
  std::vector<std::vector<double>> lost;     // per such element, mass outside of its functions
  std::vector<OperatorRows::MadeMass> made;  // mass of extensions

  bool zero_uncovered = false;
  std::vector<double> target_area;
  /// The values that the targets may take.
  detail::ElementBounds element_bounds(const Bounds& bounds, int threads) const;
  /// A field moved into bounds, component by component.
  std::vector<detail::Limited> limit(const Field& donor, const Field& moved,
                                     const detail::ElementBounds& bounds, int threads) const;

  /// Shape (components); returns the largest |element mass - mass received| too.
  struct Applied {
    Field field;
    double max_mass_defect;
  };
  Applied apply(const Field& f, int threads) const;
  double apply_element(const OperatorRows::Row& row, const Field& f, std::span<double> out) const;
};

TransferOperator::TransferOperator(std::shared_ptr<const Space> donor,
                                   std::shared_ptr<const TriangleMesh> target,
                                   const TransferOptions& options, const Progress& progress)
    : TransferOperator(detail::OperatorBy::make(detail::sweep_here, std::move(donor),
                                                std::move(target), options, progress)) {}

TransferOperator::TransferOperator(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

TransferOperator detail::OperatorBy::make(const Sweeper& sweeper,
                                          std::shared_ptr<const Space> donor,
                                          std::shared_ptr<const TriangleMesh> target,
                                          const TransferOptions& options,
                                          const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  check(donor, target, options);
  auto impl = std::make_unique<TransferOperator::Impl>();
  TransferOperator::Impl& m = *impl;
  m.donor = std::move(donor);
  m.target = Space::discontinuous(std::move(target),
                                  options.degree >= 0 ? options.degree : m.donor->highest_degree(),
                                  options.same_basis ? m.donor->basis() : options.basis);
  const detail::OverlayMesh from(m.donor->mesh(), "donor", options.threads);
  const detail::OverlayMesh to(m.target->mesh(), "target", options.threads);
  detail::Group group(from, to, m.donor, m.target,
                      {m.donor->highest_degree(), m.donor->uniform_degree()}, options.threads);
  m.rows = OperatorRows(*m.donor, *m.target);
  const detail::FrontSearch search(from);
  const std::vector<detail::ChunkResult> chunks =
      sweeper(from, to, search, {&group, 1}, options, progress,
              [&](std::size_t index, std::int32_t t, const detail::ElementBlocks& blocks) {
                m.rows.store(index, t, blocks);
              });
  detail::Swept swept = detail::balance(
      chunks, from.element_area, static_cast<std::size_t>(group.components), options.uncovered);
  m.rows.index_donors();
  m.made = m.rows.take_made();
  m.integrals = field_detail::basis_integrals(*m.target, options.threads);
  m.zero_uncovered = options.uncovered == Uncovered::zero;
  m.target_area = to.element_area;
  const auto columns = static_cast<std::size_t>(group.components);
  for (const std::int32_t d : swept.outside) {
    const std::size_t begin = static_cast<std::size_t>(d) * columns;
    const std::span<const double> given = swept.given_by(d);
    std::vector<double> rest(size_on(*m.donor, d));
    for (std::size_t c = 0; c < rest.size(); ++c)
      rest[c] = group.donor_mass[begin + c] - (given.empty() ? 0.0 : given[c]);
    m.outside.push_back(d);
    m.lost.push_back(std::move(rest));
  }
  m.report = std::move(swept.report);
  m.report.seconds.total =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return TransferOperator(std::move(impl));
}

TransferOperator::TransferOperator(TransferOperator&&) noexcept = default;
TransferOperator& TransferOperator::operator=(TransferOperator&&) noexcept = default;
TransferOperator::~TransferOperator() = default;

const std::shared_ptr<const Space>& TransferOperator::donor_space() const {
  return impl_->donor;
}
const std::shared_ptr<const Space>& TransferOperator::target_space() const {
  return impl_->target;
}
const TransferReport& TransferOperator::report() const {
  return impl_->report;
}
std::size_t TransferOperator::block_count() const {
  return impl_->rows.block_count();
}
std::size_t TransferOperator::bytes() const {
  return impl_->rows.bytes();
}
bool TransferOperator::accepts(const Space& space) const {
  return same_layout(space, *impl_->donor);
}

// One target element: the blocks act on what differs from a value of one donor, so that a constant
// comes back constant even where polynomials are continued far and the blocks' entries are large,
// and a constant takes up what rounding left of the mass received.
double TransferOperator::Impl::apply_element(const OperatorRows::Row& row, const Field& f,
                                             std::span<double> out) const {
  const auto nc = static_cast<std::size_t>(f.components());
  const std::size_t n = out.size() / nc;
  const double* own = integrals.data() + target->offset(ElementId(row.target));
  double area = 0.0;
  for (std::size_t i = 0; i < n; ++i) area += own[i];
  std::vector<double> some(nc, 0.0);
  if (!row.blocks.empty()) {
    // The mean of a donor's coefficients: theirs, to the bit, when they are equal.
    const auto d = f.coefficients(ElementId(row.blocks.front().donor));
    const std::size_t size = row.blocks.front().mass.size();
    for (std::size_t c = 0; c < nc; ++c) {
      double sum = 0.0;
      for (std::size_t m = 1; m < size; ++m) sum += d[m * nc + c] - d[c];
      some[c] = d[c] + sum / static_cast<double>(size);
    }
  }
  std::vector<double> mass(nc, 0.0);
  for (const OperatorRows::Block& block : row.blocks) {
    const auto d = f.coefficients(ElementId(block.donor));
    for (std::size_t m = 0; m < block.mass.size(); ++m) {
      for (std::size_t c = 0; c < nc; ++c) mass[c] += block.mass[m] * (d[m * nc + c] - some[c]);
    }
  }
  for (std::size_t c = 0; c < nc; ++c) mass[c] += some[c] * row.area;
  const bool full = std::abs(row.area - area) <= covered * area;
  if (!full) std::fill(some.begin(), some.end(), 0.0);
  std::fill(out.begin(), out.end(), 0.0);
  for (const OperatorRows::Block& block : row.blocks) {
    const auto d = f.coefficients(ElementId(block.donor));
    const std::size_t size = block.mass.size();
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t m = 0; m < size; ++m) {
        const double k = block.value[i * size + m];
        for (std::size_t c = 0; c < nc; ++c) out[i * nc + c] += k * (d[m * nc + c] - some[c]);
      }
    }
  }
  double defect = 0.0;
  for (std::size_t c = 0; c < nc; ++c) {
    for (std::size_t i = 0; i < n; ++i) out[i * nc + c] += some[c];
    for (int sweep = 0; sweep < 2; ++sweep) {
      double got = 0.0;
      for (std::size_t i = 0; i < n; ++i) got += out[i * nc + c] * own[i];
      const double missing = mass[c] - got;
      if (sweep == 1) {
        defect = std::max(defect, std::abs(missing));
        break;
      }
      for (std::size_t i = 0; i < n; ++i) out[i * nc + c] += missing / area;
    }
  }
  return defect;
}

TransferOperator::Impl::Applied TransferOperator::Impl::apply(const Field& f, int threads) const {
  if (!same_layout(f.space(), *donor)) {
    throw InputError("transfer operator: field '" + f.name() +
                     "' lives on another space than the operator was made for, expected the same "
                     "mesh, degree and basis");
  }
  const auto nc = static_cast<std::size_t>(f.components());
  std::vector<double> out(target->coefficient_count() * nc);
  std::vector<double> defects(rows.chunk_count(), 0.0);
  parallel_for(
      rows.chunk_count(),
      [&](std::size_t chunk) {
        rows.for_rows(chunk, [&](const OperatorRows::Row& row) {
          const std::span<double> place(out.data() + target->offset(ElementId(row.target)) * nc,
                                        size_on(*target, row.target) * nc);
          defects[chunk] = std::max(defects[chunk], apply_element(row, f, place));
        });
      },
      threads);
  return {Field(f.name(), target, std::move(out), f.components()),
          *std::ranges::max_element(defects)};
}

detail::ElementBounds TransferOperator::Impl::element_bounds(const Bounds& bounds,
                                                             int threads) const {
  detail::check_bounds(bounds);
  std::vector<detail::ElementBounds::Overlapping> pairs;
  if (bounds.kind == Bounds::Kind::local) {
    const std::vector<double> own = field_detail::basis_integrals(*donor, threads);
    std::vector<double> donor_area(donor->mesh()->element_count());
    for (std::size_t d = 0; d < donor_area.size(); ++d) {
      const auto begin = own.begin() + static_cast<std::ptrdiff_t>(donor->offset(ElementId(d)));
      donor_area[d] = std::accumulate(
          begin, begin + static_cast<std::ptrdiff_t>(size_on(*donor, static_cast<std::int32_t>(d))),
          0.0);
    }
    for (std::size_t chunk = 0; chunk < rows.chunk_count(); ++chunk) {
      rows.for_rows(chunk, [&](const OperatorRows::Row& row) {
        for (const OperatorRows::Block& block : row.blocks) {
          // The functions add up to 1, and what each gives to the area that the pair shares.
          const double shared = std::accumulate(block.mass.begin(), block.mass.end(), 0.0);
          if (detail::ElementBounds::overlaps(shared,
                                              donor_area[static_cast<std::size_t>(block.donor)],
                                              target_area[static_cast<std::size_t>(row.target)]))
            pairs.push_back({row.target, block.donor});
        }
      });
    }
  }
  std::vector<std::int32_t> zero;
  for (const auto& part : report.uncovered_elements)
    if (zero_uncovered) zero.push_back(part.first.value);
  return {bounds, std::move(pairs), std::move(zero), target_area.size(), threads};
}

std::vector<detail::Limited> TransferOperator::Impl::limit(const Field& from, const Field& moved,
                                                           const detail::ElementBounds& bounds,
                                                           int threads) const {
  std::vector<detail::Limited> limited;
  for (int c = 0; c < moved.components(); ++c)
    limited.push_back(detail::limit_discontinuous(moved, c, bounds(from, c), target_area, threads));
  return limited;
}

Field TransferOperator::apply(const Field& donor, int threads) const {
  return impl_->apply(donor, threads).field;
}

Field TransferOperator::apply(const Field& donor, const Bounds& bounds, int threads) const {
  Field moved = impl_->apply(donor, threads).field;
  if (bounds.kind == Bounds::Kind::none) return moved;
  const detail::ElementBounds values = impl_->element_bounds(bounds, threads);
  return detail::with_coefficients(moved, impl_->limit(donor, moved, values, threads));
}

TransferResult TransferOperator::transfer(std::span<const Field> donors, int threads) const {
  return transfer(donors, Bounds{}, threads);
}

TransferResult TransferOperator::transfer(std::span<const Field> donors, const Bounds& bounds,
                                          int threads) const {
  const auto start = std::chrono::steady_clock::now();
  const Impl& m = *impl_;
  TransferResult result;
  result.report = m.report;
  result.report.seconds = {};
  std::optional<detail::ElementBounds> values;
  if (bounds.kind != Bounds::Kind::none) values.emplace(m.element_bounds(bounds, threads));
  detail::Reports reports(donors.size(), threads);
  result.fields.reserve(donors.size());
  for (std::size_t k = 0; k < donors.size(); ++k) {
    const Field& f = donors[k];
    Impl::Applied applied = m.apply(f, threads);
    const auto nc = static_cast<std::size_t>(f.components());
    std::vector<double> outside(nc, 0.0);
    std::vector<double> made(nc, 0.0);
    const auto add = [&](std::int32_t d, std::span<const double> weights, std::vector<double>& to) {
      const auto own = f.coefficients(ElementId(d));
      for (std::size_t i = 0; i < weights.size(); ++i) {
        for (std::size_t c = 0; c < nc; ++c) to[c] += weights[i] * own[i * nc + c];
      }
    };
    for (std::size_t i = 0; i < m.outside.size(); ++i) add(m.outside[i], m.lost[i], outside);
    for (const OperatorRows::MadeMass& part : m.made) add(part.donor, part.mass, made);
    const std::vector<double> defect(nc, applied.max_mass_defect);
    std::vector<detail::Limited> limited;
    if (values) {
      limited = m.limit(f, applied.field, *values, threads);
      applied.field = detail::with_coefficients(applied.field, limited);
    }
    result.fields.push_back(std::move(applied.field));
    reports.add({&k, 1}, {std::array{&f},
                          std::array{&std::as_const(result.fields.back())},
                          outside,
                          made,
                          {},
                          defect});
    const auto lines = reports.lines(k);
    for (std::size_t c = 0; c < limited.size(); ++c) {
      lines[c].min_after = limited[c].range.lo;
      lines[c].max_after = limited[c].range.hi;
      lines[c].bounds = limited[c].report;
    }
  }
  result.report.fields = reports.finish();
  result.report.seconds.total =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

Field TransferOperator::apply_adjoint(const Field& g, int threads) const {
  const Impl& m = *impl_;
  if (!same_layout(g.space(), *m.target)) {
    throw InputError("transfer operator: field '" + g.name() +
                     "' does not live on the operator's target space, expected the same mesh, "
                     "degree and basis");
  }
  const auto nc = static_cast<std::size_t>(g.components());
  // M_T g element by element, then the transposed blocks, then the donor's mass matrices.
  std::vector<double> load(m.target->coefficient_count() * nc);
  const detail::ElementMass target_mass(m.target);
  const auto blocks_of = [&](std::size_t n, const auto& body) {
    parallel_for((n + detail::chunk_size - 1) / detail::chunk_size,
                 [&](std::size_t chunk) {
                   detail::ElementMass::Element element;
                   for (std::size_t e = chunk * detail::chunk_size;
                        e < std::min(n, (chunk + 1) * detail::chunk_size); ++e)
                     body(static_cast<std::int32_t>(e), element);
                 },
                 threads);
  };
  blocks_of(m.target->mesh()->element_count(), [&](std::int32_t t, auto& element) {
    target_mass.prepare(ElementId(t), element);
    detail::ElementMass::weigh({}, element);
    const auto own = g.coefficients(ElementId(t));
    const std::size_t n = size_on(*m.target, t);
    double* place = load.data() + m.target->offset(ElementId(t)) * nc;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t c = 0; c < nc; ++c)
          place[i * nc + c] += element.mass[i * n + j] * own[j * nc + c];
      }
    }
  });
  const std::shared_ptr<const Space> space = broken(m.donor);
  const detail::ElementMass donor_mass(space);
  std::vector<double> out(space->coefficient_count() * nc);
  blocks_of(space->mesh()->element_count(), [&](std::int32_t d, auto& element) {
    const std::size_t n = size_on(*space, d);
    const std::span<double> place(out.data() + space->offset(ElementId(d)) * nc, n * nc);
    m.rows.for_column(d, [&](std::int32_t t, const OperatorRows::Block& block) {
      const double* from = load.data() + m.target->offset(ElementId(t)) * nc;
      const std::size_t functions = block.value.size() / n;
      for (std::size_t i = 0; i < functions; ++i) {
        for (std::size_t k = 0; k < n; ++k) {
          for (std::size_t c = 0; c < nc; ++c)
            place[k * nc + c] += block.value[i * n + k] * from[i * nc + c];
        }
      }
    });
    donor_mass.prepare(ElementId(d), element);
    detail::ElementMass::weigh({}, element);
    if (!detail::ElementMass::solve(element, place)) {
      throw NumericsError("donor triangle " + std::to_string(d) +
                          ": its mass matrix is singular in double precision");
    }
  });
  return Field(g.name(), space, std::move(out), g.components());
}

void TransferOperator::write_matrix_market(AtomicFile& file) const {
  detail::write_matrix_market(file, impl_->rows, *impl_->donor, *impl_->target);
}

void TransferOperator::write_matrix_market(const std::string& path) const {
  AtomicFile file(path);
  write_matrix_market(file);
  file.commit();
}

}  // namespace bezel
