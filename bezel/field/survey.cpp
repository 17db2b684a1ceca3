#include "bezel/field/survey.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "bezel/bernstein/fixed_size.hpp"
#include "bezel/field/element_kernel.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel::field_detail {
namespace {

using short_names::at;

constexpr std::size_t blocks_per_task = 16;

/// As look_at_lanes(), for one component; the results stand in the first of the lanes.
void look_at_one(std::size_t first, std::size_t elements, std::size_t size, const double* c,
                 const double* basis, const double* share, LaneSurvey& found) {
  bernstein::with_triangle_size(size, [&](auto fixed) {
    const std::size_t count = fixed() > 0 ? fixed() : size;
    double low = found.low[0], high = found.high[0], slack = found.slack[0];
    for (std::size_t e = 0; e < elements; ++e, c += count) {
      double least = c[0], most = c[0];
      for (std::size_t n = 1; n < count; ++n) {
        least = c[n] < least ? c[n] : least;
        most = c[n] > most ? c[n] : most;
      }
      const std::size_t place = (first + e) * lanes;
      found.least[place] = least;
      found.most[place] = most;
      if (basis != nullptr) {
        double total = 0.0;
        for (std::size_t n = 0; n < count; ++n) total += basis[e * count + n] * c[n];
        found.integral[place] = total;
      }
      if (share != nullptr) {
        const double wider = share[e] * (most - least);
        slack = wider > slack ? wider : slack;
        least -= wider;
        most += wider;
      }
      low = least < low ? least : low;
      high = most > high ? most : high;
    }
    found.low[0] = low;
    found.high[0] = high;
    found.slack[0] = slack;
  });
}

/// Elements of one degree at once.
void look_at_elements(const Space& space, const SurveyAim& aim, const SurveyBlock& block,
                      LaneSurvey& found) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (auto* array : {&found.integral, &found.least, &found.most})
    array->resize(survey_block * lanes);
  found.low.fill(infinity);
  found.high.fill(-infinity);
  found.slack.fill(0.0);
  const double* const basis = aim.basis_integrals.empty() ? nullptr : aim.basis_integrals.data();
  const double* const share = aim.ranges == nullptr || aim.ranges->widenings().empty()
                                  ? nullptr
                                  : aim.ranges->widenings().data();
  const double* c = block.c;
  const std::size_t step = space.uniform_degree() >= 0 ? block.to - block.from : 1;
  for (std::size_t e = block.from; e < block.to; e += step) {
    const ElementId id(e);
    const std::size_t size = at(bernstein::triangle_size(space.degree(id)));
    const auto looking = block.width == 1 ? look_at_one : look_at_lanes;
    looking(e - block.from, step, size, c, basis == nullptr ? nullptr : basis + space.offset(id),
            share == nullptr ? nullptr : share + e, found);
    c += step * size * block.width;
  }
}

/// Integrals of |f| on the elements of a block.
void find_absolute(const Space& space, const AbsIntegral& absolute, const SurveyBlock& block,
                   std::size_t components, SurveyRoom& room, double* to) {
  room.points.resize(absolute.room());
  const LaneSurvey& found = room.found;
  const double* c = block.c;
  for (std::size_t e = block.from; e < block.to; ++e, to += components) {
    const std::size_t place = (e - block.from) * lanes;
    for (std::size_t k = 0; k < block.count; ++k)
      to[k] = absolute(e, c + k, block.width, found.least[place + k], found.most[place + k],
                       found.integral[place + k], room.points);
    c += at(bernstein::triangle_size(space.degree(ElementId(e)))) * block.width;
  }
}

}  // namespace

void copy_rows(std::size_t rows, std::size_t count, const double* from, std::size_t from_stride,
               double* to, std::size_t to_stride) {
  for (std::size_t r = 0; r < rows; ++r, from += from_stride, to += to_stride) {
    if (count == lanes)
      std::copy_n(from, lanes, to);
    else
      for (std::size_t k = 0; k < count; ++k) to[k] = from[k];
  }
}

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
          SurveyRoom& room) {
  const std::size_t components = survey.bounds.components;
  look_at_elements(space, aim, block, room.found);
  const std::size_t begin = block.from * components + block.first;
  if (!aim.basis_integrals.empty())
    copy_rows(block.to - block.from, block.count, room.found.integral.data(), lanes,
              survey.integrals.data() + begin, components);
  if (aim.absolute != nullptr)
    find_absolute(space, *aim.absolute, block, components, room, survey.absolute.data() + begin);
  if (aim.ranges == nullptr) return;
  const std::span<const double> share = aim.ranges->widenings();
  // Where an element must be bounded by itself, that is done where it matters.
  if (!share.empty() && std::any_of(share.begin() + static_cast<std::ptrdiff_t>(block.from),
                                    share.begin() + static_cast<std::ptrdiff_t>(block.to),
                                    [](double own) { return own < 0.0; })) {
    room.found.low.fill(-std::numeric_limits<double>::infinity());
    room.found.high.fill(std::numeric_limits<double>::infinity());
  }
  const std::size_t place = block.from / survey_block * components + block.first;
  std::copy_n(room.found.low.begin(), block.count, survey.bounds.low.data() + place);
  std::copy_n(room.found.high.begin(), block.count, survey.bounds.high.data() + place);
  std::copy_n(room.found.slack.begin(), block.count, survey.bounds.slack.data() + place);
}

Survey survey(const Space& space, std::span<const Column> columns, const SurveyAim& aim,
              int threads, const std::function<void(const SurveyBlock&)>& visit) {
  const std::size_t elements = space.mesh()->element_count();
  Survey found = make_survey(space, columns.size(), aim);
  const std::size_t per_task = blocks_per_task * survey_block;
  parallel_for((elements + per_task - 1) / per_task,
               [&](std::size_t task) {
                 std::vector<double> gathered;
                 SurveyRoom room;
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
                       gathered.resize(size * width);
                       for (std::size_t k = 0; k < width; ++k) {
                         const Column& column = columns[first + std::min(k, count - 1)];
                         const double* from_c = column.first + begin * column.stride;
                         for (std::size_t n = 0; n < size; ++n)
                           gathered[n * width + k] = from_c[n * column.stride];
                       }
                       block.c = gathered.data();
                     }
                     look(space, aim, block, found, room);
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
