#include "bezel/transfer/series.hpp"

#include <algorithm>

#include "bezel/transfer/distributed.hpp"
#include "bezel/transfer/layout.hpp"

namespace bezel {
namespace {

/// Pairs per element of both meshes, for estimating memory.
constexpr double pairs_per_element = 4.0;

double functions(const Space& space) {
  return bernstein::triangle_size(space.highest_degree());
}

/// Bounds are kept after an operator is applied.
TransferOptions without_bounds(TransferOptions options) {
  options.bounds = {};
  return options;
}

}  // namespace

TransferSeries::TransferSeries(std::shared_ptr<const TriangleMesh> target, TransferOptions options,
                               std::size_t memory, Processes* processes)
    : target_(std::move(target)),
      options_(std::move(options)),
      memory_(memory),
      processes_(processes) {}

bool TransferSeries::worth_keeping(const Field& field) const {
  if (options_.weight || !options_.density.empty() || !target_ ||
      !detail::is_linear(without_bounds(options_)))
    return false;
  const double n = functions(field.space());
  const double t = options_.degree >= 0 ? bernstein::triangle_size(options_.degree) : n;
  const auto elements =
      static_cast<double>(field.mesh().element_count() + target_->element_count());
  return 8.0 * (t + 1.0) * n * pairs_per_element * elements <= static_cast<double>(memory_);
}

TransferResult TransferSeries::step(std::span<const Field> donors, bool comes_again,
                                    const Progress& progress) {
  if (!donors.empty() && !operators_.empty() &&
      !detail::same_mesh(donors.front().mesh(), *operators_.front().donor_space()->mesh()))
    operators_.clear();
  const bool keep = !donors.empty() && (comes_again || !operators_.empty()) &&
                    std::ranges::all_of(donors, [&](const Field& f) {
                      return &f.mesh() == &donors.front().mesh() && worth_keeping(f);
                    });
  if (!keep) {
    ++geometries_;
    return processes_ != nullptr ? processes_->transfer(donors, target_, options_, progress)
                                 : transfer(donors, target_, options_, progress);
  }
  TransferResult result;
  double seconds = 0.0;
  for (const Field& f : donors) {
    const auto known = std::ranges::find_if(
        operators_, [&](const TransferOperator& o) { return o.accepts(f.space()); });
    std::size_t at = static_cast<std::size_t>(known - operators_.begin());
    if (known == operators_.end()) {
      const TransferOptions linear = without_bounds(options_);
      operators_.push_back(
          processes_ != nullptr
              ? processes_->transfer_operator(f.space_ptr(), target_, linear, progress)
              : TransferOperator(f.space_ptr(), target_, linear, progress));
      seconds += operators_.back().report().seconds.total;
      ++geometries_;
    }
    TransferResult moved = operators_[at].transfer({&f, 1}, options_.bounds, options_.threads);
    if (result.fields.empty()) {
      result.report = std::move(moved.report);
    } else {
      const auto& lines = moved.report.fields;
      result.report.fields.insert(result.report.fields.end(), lines.begin(), lines.end());
      seconds += moved.report.seconds.total;
    }
    result.fields.push_back(std::move(moved.fields.front()));
  }
  result.report.seconds.total += seconds;
  return result;
}

}  // namespace bezel
