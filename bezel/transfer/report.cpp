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

std::span<FieldReport> Reports::add(std::size_t place, const Field& donor, const Field& moved,
                                    std::span<const double> outside, std::span<const double> made,
                                    std::span<const double> spread,
                                    std::span<const double> element_defect) {
  const auto element_masses = [&](const Field& f) {
    Measures& m = measures(f);
    if (m.basis_integrals.empty())
      m.basis_integrals = field_detail::basis_integrals(f.space(), threads_);
    return field_detail::element_integrals(f, m.basis_integrals, threads_);
  };
  const std::vector<double> own = element_masses(donor);
  const auto before = field_detail::integral(donor, own);
  const auto after = field_detail::integral(moved, element_masses(moved));
  Measures& of_donor = measures(donor);
  if (!of_donor.abs_integral)
    of_donor.abs_integral = std::make_unique<field_detail::AbsIntegral>(donor.space_ptr());
  const auto size = (*of_donor.abs_integral)(donor, own, threads_);
  const std::size_t first = lines_[place].size();
  for (std::size_t c = 0; c < before.size(); ++c) {
    FieldReport line;
    line.name = donor.name();
    line.component = static_cast<int>(c);
    line.mass_before = before[c];
    line.mass_after = after[c];
    line.mass_outside = outside[c];
    line.mass_made = made[c];
    if (!spread.empty()) line.mass_spread = spread[c];
    const double defect =
        after[c] - (before[c] - line.mass_outside + line.mass_made + line.mass_spread);
    const double scale = size[c] > 0.0 ? size[c] : 1.0;
    line.relative_mass_defect = std::abs(defect) / scale;
    line.max_element_defect = element_defect[c] / scale;
    add(place, donor, moved, std::move(line));
  }
  return std::span(lines_[place]).subspan(first);
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
    if (!m.ranges) m.ranges = std::make_unique<ValueRanges>(f.space_ptr());
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
