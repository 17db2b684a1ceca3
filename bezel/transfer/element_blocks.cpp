// The pairs of a target element kept apart, for an operator's blocks.

#include <algorithm>

#include "bezel/transfer/element_kernel.hpp"

namespace bezel::detail {

void ElementBlocks::reset(std::size_t with_columns) {
  columns = with_columns;
  for (auto* list : {&donor, &made_donor}) list->clear();
  for (auto* list : {&product, &mass, &value, &made}) list->clear();
  area = 0.0;
}

void ElementTransfer::keep_pair(std::int32_t d, Accumulators& sums, std::span<const double> mass,
                                ElementBlocks& blocks) {
  const auto at = static_cast<std::size_t>(
      std::find(blocks.donor.begin(),
                blocks.donor.begin() + static_cast<std::ptrdiff_t>(blocks.made_donor.size()), d) -
      blocks.donor.begin());
  const std::size_t size = sums.product.size();
  if (at < blocks.made_donor.size()) {  // a donor extended into a gap beside it
    for (std::size_t i = 0; i < size; ++i) blocks.product[at * size + i] += sums.product[i];
    for (std::size_t c = 0; c < mass.size(); ++c) blocks.mass[at * mass.size() + c] += mass[c];
  } else {
    blocks.donor.push_back(d);
    blocks.product.insert(blocks.product.end(), sums.product.begin(), sums.product.end());
    blocks.mass.insert(blocks.mass.end(), mass.begin(), mass.end());
  }
  std::fill(sums.product.begin(), sums.product.end(), 0.0);
}

void ElementBlocks::move_mass(std::int32_t d, double sign, std::span<const double> change,
                              bool is_made) {
  const auto add = [&](std::vector<std::int32_t>& to, std::vector<double>& masses) {
    const auto at = static_cast<std::size_t>(std::find(to.begin(), to.end(), d) - to.begin());
    if (at == to.size()) {
      to.push_back(d);
      masses.resize(masses.size() + columns, 0.0);
    }
    for (std::size_t c = 0; c < columns; ++c) masses[at * columns + c] += sign * change[c];
    return at;
  };
  if (is_made) {
    add(made_donor, made);
    return;
  }
  const std::size_t size = donor.empty() ? 0 : product.size() / donor.size();
  add(donor, mass);
  product.resize(donor.size() * size, 0.0);
}

void ElementTransfer::finish_blocks(const Group& g, std::int32_t t, Accumulators& sums, double area,
                                    ElementBlocks& blocks, ElementOutcome& outcome) {
  blocks.area = area;
  // One solve with the columns of all pairs side by side.
  const std::size_t functions = sums.basis.size();
  const std::size_t pairs = blocks.donor.size();
  const std::size_t columns = blocks.columns;
  sums.product.resize(functions * pairs * columns);
  for (std::size_t k = 0; k < pairs; ++k) {
    for (std::size_t n = 0; n < functions; ++n) {
      std::copy_n(blocks.product.data() + (k * functions + n) * columns, columns,
                  sums.product.data() + (n * pairs + k) * columns);
    }
  }
  blocks.value.assign(functions * pairs * columns, 0.0);
  const std::vector<double> none(blocks.mass.size(), 0.0);
  finish(g, t, sums, {}, blocks.mass, none, area, blocks.value, outcome);
}

}  // namespace bezel::detail
