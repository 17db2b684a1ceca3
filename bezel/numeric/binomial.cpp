#include "bezel/numeric/binomial.hpp"

#include <array>
#include <string>

#include "bezel/base/error.hpp"
#include "bezel/numeric/binomial_kernel.hpp"

namespace bezel {
namespace {

__extension__ using Wide = unsigned __int128;

constexpr std::size_t table_size = (max_binomial + 1) * (max_binomial + 2) / 2;
constexpr std::size_t position(int n, int k) {
  return static_cast<std::size_t>(n * (n + 1) / 2 + k);
}

constexpr std::array<Wide, table_size> make_exact() {
  std::array<Wide, table_size> table{};
  for (int n = 0; n <= max_binomial; ++n)
    for (int k = 0; k <= n; ++k)
      table[position(n, k)] =
          k == 0 || k == n ? Wide{1} : table[position(n - 1, k - 1)] + table[position(n - 1, k)];
  return table;
}
constexpr std::array<Wide, table_size> exact = make_exact();

// The conversion of a 128-bit integer to double rounds to nearest even.
constexpr std::array<double, table_size> make_rounded() {
  std::array<double, table_size> table{};
  for (std::size_t i = 0; i < table_size; ++i) table[i] = static_cast<double>(exact[i]);
  return table;
}
constexpr std::array<double, table_size> rounded = make_rounded();

void check(int n) {
  if (n < 0 || n > max_binomial)
    throw InputError("binomial coefficient C(" + std::to_string(n) +
                     ", k), expected 0 <= n <= " + std::to_string(max_binomial));
}

}  // namespace

namespace kernel {
constinit const double* const binomial_table = rounded.data();
}  // namespace kernel

double binomial(int n, int k) {
  check(n);
  return k < 0 || k > n ? 0.0 : rounded[position(n, k)];
}

Integer128 exact_binomial(int n, int k) {
  check(n);
  const Wide value = k < 0 || k > n ? Wide{0} : exact[position(n, k)];
  return {static_cast<std::uint64_t>(value >> 64), static_cast<std::uint64_t>(value)};
}

}  // namespace bezel
