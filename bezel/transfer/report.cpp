#include "bezel/transfer/report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bezel/base/parallel.hpp"

namespace bezel::detail {

Reports::Measures& Reports::measures(const std::shared_ptr<const Space>& space) {
  for (const auto& known : measures_)
    if (known->space == space) return *known;
  measures_.push_back(std::make_unique<Measures>());
  measures_.back()->space = space;
  return *measures_.back();
}

void Reports::know(const std::shared_ptr<const Space>& space, std::vector<double> basis_integrals) {
  measures(space).basis_integrals = std::move(basis_integrals);
}

std::vector<double> Reports::element_masses(std::span<const Field* const> fields) {
  Measures& m = measures(*fields.front());
  if (m.basis_integrals.empty())
    m.basis_integrals = field_detail::basis_integrals(*m.space, threads_);
  return field_detail::element_integrals(fields, m.basis_integrals, threads_);
}

void Reports::add(std::span<const std::size_t> places, const MovedFields& fields) {
  const std::size_t components = field_detail::component_count(fields.donors);
  std::vector<double> found;
  if (fields.element_mass.empty()) found = element_masses(fields.donors);
  const std::span<const double> own = found.empty() ? fields.element_mass : found;
  const auto before = field_detail::integral(own, components);
  const auto after = field_detail::integral(element_masses(fields.moved), components);
  Measures& of_donor = measures(*fields.donors.front());
  if (!of_donor.abs_integral)
    of_donor.abs_integral = std::make_unique<field_detail::AbsIntegral>(of_donor.space, threads_);
  const auto size = (*of_donor.abs_integral)(fields.donors, own, threads_);
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
      add(places[k], donor, *fields.moved[k], std::move(line));
    }
  }
}

void Reports::add(std::size_t place, const Field& donor, const Field& moved, FieldReport line) {
  line.min_after = -std::numeric_limits<double>::infinity();
  line.max_after = std::numeric_limits<double>::infinity();
  sought_.push_back({&donor, &moved, place, lines_[place].size()});
  lines_[place].push_back(std::move(line));
}

std::vector<FieldReport> Reports::finish() {
  const auto prepare = [&](const Field& f) {
    Measures& m = measures(f);
    if (!m.ranges) m.ranges = std::make_unique<ValueRanges>(f.space_ptr(), threads_);
  };
  for (const Sought& s : sought_) {
    prepare(*s.donor);
    prepare(*s.moved);
  }
  parallel_for(
      2 * sought_.size(),
      [&](std::size_t i) {
        const Sought& s = sought_[i / 2];
        FieldReport& line = lines_[s.place][s.line];
        const Field& field = i % 2 == 0 ? *s.donor : *s.moved;
        const bernstein::Range range = (*measures(field).ranges)(field, line.component);
        if (i % 2 == 0) {
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
