#include "bezel/field/survey.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "bezel/bernstein/fixed_size.hpp"
#include "bezel/field/element_kernel.hpp"

namespace bezel::field_detail {
namespace {

constexpr std::size_t blocks_per_task = 16;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

/// Values of several components: the compiler makes vectors of the loops.
template <std::size_t width>
using Pack = std::array<double, width>;

/// Elements of `fixed` coefficients each, or as many as their degrees say when it is 0.
template <std::size_t fixed, std::size_t width>
void look_at(const Space& space, const SurveyAim& aim, const SurveyBlock& block, Survey& survey,
             std::vector<double>& scratch) {
  const std::size_t components = survey.bounds.components;
  const bool integrate = !aim.basis_integrals.empty();
  const double* basis =
      integrate ? aim.basis_integrals.data() + space.offset(ElementId(block.from)) : nullptr;
  const double* c = block.c;
  Pack<width> low, high, slack{};
  for (std::size_t e = block.from; e < block.to; ++e) {
    const std::size_t size =
        fixed > 0 ? fixed : at(bernstein::triangle_size(space.degree(ElementId(e))));
    Pack<width> total{};
    if (integrate) {
      for (std::size_t n = 0; n < size; ++n)
        for (std::size_t k = 0; k < width; ++k) total[k] += basis[n] * c[n * width + k];
      std::copy_n(total.begin(), block.count,
                  survey.integrals.data() + e * components + block.first);
      basis += size;
    }
    Pack<width> least, most;
    for (std::size_t k = 0; k < width; ++k) least[k] = most[k] = c[k];
    for (std::size_t n = 1; n < size; ++n) {
      for (std::size_t k = 0; k < width; ++k) {
        const double x = c[n * width + k];
        least[k] = x < least[k] ? x : least[k];
        most[k] = x > most[k] ? x : most[k];
      }
    }
    if (aim.absolute != nullptr) {
      double* const to = survey.absolute.data() + e * components + block.first;
      for (std::size_t k = 0; k < block.count; ++k)
        to[k] = (*aim.absolute)(e, c + k, width, least[k], most[k], total[k], scratch);
    }
    if (aim.ranges != nullptr) {
      const double share = aim.ranges->widening(e);
      if (share < 0.0) {  // bounded by itself, where it matters
        least.fill(-std::numeric_limits<double>::infinity());
        most.fill(std::numeric_limits<double>::infinity());
      } else {
        for (std::size_t k = 0; k < width; ++k) {
          const double wider = share * (most[k] - least[k]);
          slack[k] = wider > slack[k] ? wider : slack[k];
          least[k] -= wider;
          most[k] += wider;
        }
      }
      if (e == block.from) {
        low = least;
        high = most;
      }
      for (std::size_t k = 0; k < width; ++k) {
        low[k] = least[k] < low[k] ? least[k] : low[k];
        high[k] = most[k] > high[k] ? most[k] : high[k];
      }
    }
    c += size * width;
  }
  if (aim.ranges == nullptr) return;
  const std::size_t place = block.from / survey_block * components + block.first;
  std::copy_n(low.begin(), block.count, survey.bounds.low.data() + place);
  std::copy_n(high.begin(), block.count, survey.bounds.high.data() + place);
  std::copy_n(slack.begin(), block.count, survey.bounds.slack.data() + place);
}

}  // namespace

std::vector<Column> columns_of(std::span<const Field* const> fields) {
  std::vector<Column> columns;
  for (const Field* f : fields) {
    const auto own = at(f->components());
    for (std::size_t c = 0; c < own; ++c) columns.push_back({f->coefficients().data() + c, own});
  }
  return columns;
}

Survey make_survey(const Space& space, std::size_t components, const SurveyAim& aim) {
  const std::size_t elements = space.mesh()->element_count();
  const std::size_t blocks = (elements + survey_block - 1) / survey_block;
  Survey made;
  if (!aim.basis_integrals.empty()) made.integrals.resize(elements * components);
  if (aim.absolute != nullptr) made.absolute.resize(elements * components);
  made.bounds.components = components;
  if (aim.ranges != nullptr)
    for (auto* array : {&made.bounds.low, &made.bounds.high, &made.bounds.slack})
      array->resize(blocks * components);
  return made;
}

void look(const Space& space, const SurveyAim& aim, const SurveyBlock& block, Survey& survey,
          std::vector<double>& scratch) {
  if (aim.absolute != nullptr) scratch.resize(aim.absolute->room());
  const int uniform = space.uniform_degree();
  bernstein::with_triangle_size(
      uniform >= 0 ? at(bernstein::triangle_size(uniform)) : 0, [&](auto fixed) {
        if (block.width == 1)
          look_at<fixed(), 1>(space, aim, block, survey, scratch);
        else
          look_at<fixed(), survey_width>(space, aim, block, survey, scratch);
      });
}

Survey survey(const Space& space, std::span<const Column> columns, const SurveyAim& aim,
              int threads, const std::function<void(const SurveyBlock&)>& visit) {
  const std::size_t elements = space.mesh()->element_count();
  Survey found = make_survey(space, columns.size(), aim);
  const std::size_t per_task = blocks_per_task * survey_block;
  parallel_for((elements + per_task - 1) / per_task,
               [&](std::size_t task) {
                 std::vector<double> room, scratch;
                 const std::size_t end = std::min(elements, (task + 1) * per_task);
                 for (std::size_t from = task * per_task; from < end; from += survey_block) {
                   const std::size_t to = std::min(end, from + survey_block);
                   const ElementId last(to - 1);
                   const std::size_t begin = space.offset(ElementId(from));
                   const std::size_t size = space.offset(last) +
                                            at(bernstein::triangle_size(space.degree(last))) -
                                            begin;
                   for (std::size_t first = 0; first < columns.size();) {
                     // Few are not worth the lanes that stay empty.
                     const bool few = columns.size() - first <= 2;
                     const std::size_t width = few ? 1 : survey_width;
                     const std::size_t count = std::min(width, columns.size() - first);
                     SurveyBlock block{from, to, first, count, width, nullptr};
                     if (few && columns[first].stride == 1) {
                       block.c = columns[first].first + begin;
                     } else {
                       room.resize(size * width);
                       for (std::size_t k = 0; k < width; ++k) {
                         const Column& column = columns[first + std::min(k, count - 1)];
                         const double* from_c = column.first + begin * column.stride;
                         for (std::size_t n = 0; n < size; ++n)
                           room[n * width + k] = from_c[n * column.stride];
                       }
                       block.c = room.data();
                     }
                     look(space, aim, block, found, scratch);
                     if (visit) visit(block);
                     first += count;
                   }
                 }
               },
               threads);
  return found;
}

std::span<const double> SpaceMeasures::basis_integrals() {
  if (basis_integrals_.empty()) basis_integrals_ = field_detail::basis_integrals(*space_, threads_);
  return basis_integrals_;
}

const AbsIntegral& SpaceMeasures::absolute() {
  if (!absolute_) absolute_ = std::make_unique<AbsIntegral>(space_, threads_);
  return *absolute_;
}

const ValueRanges& SpaceMeasures::ranges() {
  if (!ranges_) ranges_ = std::make_unique<ValueRanges>(space_, threads_);
  return *ranges_;
}

}  // namespace bezel::field_detail
