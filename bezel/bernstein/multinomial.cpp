#include "bezel/bernstein/multinomial.hpp"

#include <array>
#include <cstddef>
#include <vector>

#include "bezel/bernstein/checks.hpp"
#include "bezel/numeric/binomial.hpp"

namespace bezel::bernstein {

std::span<const double> multinomials(int degree) {
  checks::degree(degree, max_multinomial_degree, "triangle");
  using Tables = std::array<std::vector<double>, max_multinomial_degree + 1>;
  static const Tables tables = [] {
    Tables all;
    for (int d = 0; d <= max_multinomial_degree; ++d)
      for (int k = 0; k <= d; ++k)
        for (int j = 0; j <= d - k; ++j)
          all[static_cast<std::size_t>(d)].push_back(binomial(d, k) * binomial(d - k, j));
    return all;
  }();
  return tables[static_cast<std::size_t>(degree)];
}

}  // namespace bezel::bernstein
