#include "bezel/transfer/report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bezel/base/parallel.hpp"

namespace bezel::detail {

using field_detail::Survey;
using field_detail::SurveyAim;

field_detail::SpaceMeasures& Reports::measures(const std::shared_ptr<const Space>& space) {
  for (const auto& known : measures_)
    if (known->space() == space) return *known;
  measures_.push_back(std::make_shared<field_detail::SpaceMeasures>(space, threads_));
  return *measures_.back();
}

void Reports::know(std::shared_ptr<field_detail::SpaceMeasures> measures) {
  measures_.push_back(std::move(measures));
}

void Reports::add(std::span<const std::size_t> places, const MovedFields& fields) {
  const std::size_t components = field_detail::component_count(fields.donors);
  const auto survey = [&](std::span<const Field* const> of, bool absolute) {
    field_detail::SpaceMeasures& m = measures(of.front()->space_ptr());
    const SurveyAim aim{m.basis_integrals(), absolute ? &m.absolute() : nullptr, &m.ranges()};
    return field_detail::survey(*m.space(), field_detail::columns_of(of), aim, threads_);
  };
  const Survey found_before = fields.before != nullptr ? Survey{} : survey(fields.donors, true);
  const Survey found_after = fields.after != nullptr ? Survey{} : survey(fields.moved, false);
  const Survey& of_donors = fields.before != nullptr ? *fields.before : found_before;
  const Survey& of_moved = fields.after != nullptr ? *fields.after : found_after;
  const auto before = field_detail::integral(of_donors.integrals, components);
  const auto after = field_detail::integral(of_moved.integrals, components);
  const auto size = field_detail::integral(of_donors.absolute, components);
  const auto bounds_before = std::make_shared<const field_detail::BlockBounds>(of_donors.bounds),
             bounds_after = std::make_shared<const field_detail::BlockBounds>(of_moved.bounds);
  std::size_t c = 0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const Field& donor = *fields.donors[k];
    for (int component = 0; component < donor.components(); ++component, ++c) {
      FieldReport line;
      line.name = donor.name();
      line.component = component;
      line.mass_before = before[c];
      line.mass_after = after[c];
      line.mass_outside = fields.outside[c];
      line.mass_made = fields.made[c];
      if (!fields.spread.empty()) line.mass_spread = fields.spread[c];
      const double defect =
          after[c] - (before[c] - line.mass_outside + line.mass_made + line.mass_spread);
      const double scale = size[c] > 0.0 ? size[c] : 1.0;
      line.relative_mass_defect = std::abs(defect) / scale;
      line.max_element_defect = fields.element_defect[c] / scale;
      seek(places[k], std::move(line), {&donor, bounds_before, c},
           {fields.moved[k], bounds_after, c});
    }
  }
}

void Reports::add(std::size_t place, const Field& donor, const Field& moved, FieldReport line) {
  seek(place, std::move(line), {&donor, nullptr, 0}, {&moved, nullptr, 0});
}

void Reports::seek(std::size_t place, FieldReport line, Sought before, Sought after) {
  line.min_after = -std::numeric_limits<double>::infinity();
  line.max_after = std::numeric_limits<double>::infinity();
  for (Sought* s : {&before, &after}) {
    s->before = s == &before;
    s->place = place;
    s->line = lines_[place].size();
    sought_.push_back(std::move(*s));
  }
  lines_[place].push_back(std::move(line));
}

std::vector<FieldReport> Reports::finish() {
  for (const Sought& s : sought_) measures(s.field->space_ptr()).ranges();
  parallel_for(
      sought_.size(),
      [&](std::size_t i) {
        const Sought& s = sought_[i];
        FieldReport& line = lines_[s.place][s.line];
        const ValueRanges& ranges = measures(s.field->space_ptr()).ranges();
        const bernstein::Range range = s.bounds
                                           ? ranges(*s.field, line.component, *s.bounds, s.number)
                                           : ranges(*s.field, line.component);
        if (s.before) {
          line.min_before = range.lo;
          line.max_before = range.hi;
        } else {
          line.min_after = std::max(line.min_after, range.lo);
          line.max_after = std::min(line.max_after, range.hi);
        }
      },
      threads_);
  std::vector<FieldReport> all;
  for (std::vector<FieldReport>& own : lines_)
    all.insert(all.end(), std::make_move_iterator(own.begin()), std::make_move_iterator(own.end()));
  return all;
}

}  // namespace bezel::detail
