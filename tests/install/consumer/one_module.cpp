#include <array>
#include <cstdio>

#include "bezel/bernstein/interval.hpp"

int main() {
  const std::array<double, 3> b{0.0, 0.5, 1.0};
  std::printf("%g\n", bezel::bernstein::evaluate<double>(b, 0.5));
}
