#include "bezel/transfer/operator_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numeric>

#include "bezel/base/atomic_file.hpp"
#include "bezel/transfer/sweep.hpp"

namespace bezel::detail {

OperatorRows::OperatorRows(const Space& donor, const Space& target) {
  const std::size_t donors = donor.mesh()->element_count();
  const std::size_t targets = target.mesh()->element_count();
  const auto size = [&](std::size_t e) {
    return static_cast<std::uint32_t>(bernstein::triangle_size(donor.degree(ElementId(e))));
  };
  if (donor.uniform_degree() >= 0) {
    donor_size_ = {size(0)};
  } else {
    for (std::size_t e = 0; e < donors; ++e) donor_size_.push_back(size(e));
  }
  chunks_.resize((targets + chunk_size - 1) / chunk_size);
  place_.resize(targets);
  column_first_.assign(donors + 1, 0);
}

void OperatorRows::store(std::size_t index, std::int32_t t, const ElementBlocks& blocks) {
  Chunk& chunk = chunks_[index / chunk_size];
  place_[static_cast<std::size_t>(t)] = index;
  if (chunk.first_pair.empty()) {
    chunk.first_pair.push_back(0);
    chunk.offset.push_back(0);
  }
  const std::size_t pairs = blocks.donor.size();
  const std::size_t columns = blocks.columns;
  const std::size_t rows = pairs == 0 ? 0 : blocks.value.size() / (pairs * columns);
  std::vector<std::size_t> order(pairs);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t k) { return blocks.donor[k]; });
  for (const std::size_t k : order) {
    const std::size_t used = functions(blocks.donor[k]);
    for (std::size_t n = 0; n < rows; ++n) {
      const auto from =
          blocks.value.begin() + static_cast<std::ptrdiff_t>((n * pairs + k) * columns);
      chunk.values.insert(chunk.values.end(), from, from + static_cast<std::ptrdiff_t>(used));
    }
    const auto mass = blocks.mass.begin() + static_cast<std::ptrdiff_t>(k * columns);
    chunk.values.insert(chunk.values.end(), mass, mass + static_cast<std::ptrdiff_t>(used));
    chunk.donor.push_back(blocks.donor[k]);
    chunk.offset.push_back(chunk.values.size());
  }
  for (std::size_t k = 0; k < blocks.made_donor.size(); ++k) {
    const auto mass = blocks.made.begin() + static_cast<std::ptrdiff_t>(k * columns);
    const std::size_t used = functions(blocks.made_donor[k]);
    chunk.made.push_back({blocks.made_donor[k],
                          std::vector<double>(mass, mass + static_cast<std::ptrdiff_t>(used))});
  }
  chunk.target.push_back(t);
  chunk.area.push_back(blocks.area);
  chunk.first_pair.push_back(chunk.donor.size());
}

void OperatorRows::index_donors() {
  std::size_t total = 0;
  for (Chunk& chunk : chunks_) {
    chunk.values.shrink_to_fit();
    total += chunk.donor.size();
    for (const std::int32_t d : chunk.donor) ++column_first_[static_cast<std::size_t>(d) + 1];
  }
  std::partial_sum(column_first_.begin(), column_first_.end(), column_first_.begin());
  column_.resize(total);
  std::vector<std::size_t> next(column_first_.begin(), column_first_.end() - 1);
  for (std::size_t c = 0; c < chunks_.size(); ++c) {
    const Chunk& chunk = chunks_[c];
    for (std::size_t i = 0; i < chunk.target.size(); ++i) {
      for (std::size_t pair = chunk.first_pair[i]; pair < chunk.first_pair[i + 1]; ++pair) {
        column_[next[static_cast<std::size_t>(chunk.donor[pair])]++] = {
            static_cast<std::uint32_t>(c), static_cast<std::uint32_t>(pair), chunk.target[i]};
      }
    }
  }
}

std::vector<OperatorRows::MadeMass> OperatorRows::take_made() {
  std::vector<MadeMass> all;
  for (Chunk& chunk : chunks_) {
    std::ranges::move(chunk.made, std::back_inserter(all));
    chunk.made.clear();
  }
  return all;
}

std::size_t OperatorRows::bytes() const {
  std::size_t sum = column_.size() * sizeof(Entry) + column_first_.size() * sizeof(std::size_t);
  for (const Chunk& chunk : chunks_) {
    sum += chunk.values.capacity() * sizeof(double) +
           chunk.offset.capacity() * sizeof(std::size_t) +
           chunk.donor.capacity() * sizeof(std::int32_t);
  }
  return sum;
}

OperatorRows::Block OperatorRows::block(const Chunk& chunk, std::size_t pair) const {
  const std::size_t columns = functions(chunk.donor[pair]);
  const std::size_t size = chunk.offset[pair + 1] - chunk.offset[pair];
  const double* begin = chunk.values.data() + chunk.offset[pair];
  return {chunk.donor[pair], {begin, size - columns}, {begin + (size - columns), columns}};
}

void OperatorRows::fill_row(std::size_t chunk, std::size_t i, Row& row) const {
  const Chunk& from = chunks_[chunk];
  row.target = from.target[i];
  row.area = from.area[i];
  row.blocks.clear();
  for (std::size_t pair = from.first_pair[i]; pair < from.first_pair[i + 1]; ++pair)
    row.blocks.push_back(block(from, pair));
}

void OperatorRows::row(std::int32_t t, Row& out) const {
  const std::size_t index = place_[static_cast<std::size_t>(t)];
  fill_row(index / chunk_size, index % chunk_size, out);
}

void write_matrix_market(AtomicFile& file, const OperatorRows& rows, const Space& donor,
                         const Space& target) {
  std::size_t entries = 0;
  for (std::size_t chunk = 0; chunk < rows.chunk_count(); ++chunk) {
    rows.for_rows(chunk, [&](const OperatorRows::Row& row) {
      for (const OperatorRows::Block& block : row.blocks)
        entries +=
            block.value.size() - static_cast<std::size_t>(std::ranges::count(block.value, 0.0));
    });
  }
  file.write(
      fmt::format("%%MatrixMarket matrix coordinate real general\n"
                  "% conservative transfer: rows are Bernstein coefficients of the target field, "
                  "columns those of the donor field,\n"
                  "% element by element in the order of the meshes\n"
                  "{} {} {}\n",
                  target.coefficient_count(), donor.coefficient_count(), entries));
  OperatorRows::Row row;
  std::string text;
  for (std::size_t t = 0; t < target.mesh()->element_count(); ++t) {
    rows.row(static_cast<std::int32_t>(t), row);
    text.clear();
    const auto functions =
        static_cast<std::size_t>(bernstein::triangle_size(target.degree(ElementId(t))));
    for (std::size_t i = 0; i < functions; ++i) {
      for (const OperatorRows::Block& block : row.blocks) {
        const std::size_t columns = block.mass.size();
        const std::size_t first = donor.offset(ElementId(block.donor)) + 1;
        for (std::size_t k = 0; k < columns; ++k) {
          const double value = block.value[i * columns + k];
          if (value == 0.0) continue;
          fmt::format_to(std::back_inserter(text), "{} {} {}\n",
                         target.offset(ElementId(t)) + i + 1, first + k, value);
        }
      }
    }
    file.write(text);
  }
}

}  // namespace bezel::detail
