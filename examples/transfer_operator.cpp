// Does the geometry between two meshes once, moves a field at many times with it, and pulls a
// gradient back with the adjoint.
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>

#include "bezel/field/field.hpp"
#include "bezel/io/io.hpp"
#include "bezel/transfer/operator.hpp"

int main(int argc, char** argv) try {
  using namespace bezel;
  if (argc != 3) {
    std::fprintf(stderr, "usage: example_transfer_operator DONOR.msh TARGET.msh\n");
    return 2;
  }
  const Dataset donor = read(argv[1]);
  const Dataset target = read(argv[2]);
  const auto space = Space::discontinuous(donor.mesh, 2);
  TransferOptions options;
  options.uncovered = Uncovered::extend;
  const TransferOperator move(space, target.mesh, options);
  std::printf("%zu pairs of elements\n", move.block_count());

  double worst = 0.0;
  for (int step = 0; step < 20; ++step) {
    const std::string time = std::to_string(0.1 * step);
    const Field f = project("f", space, std::array{Formula("sin(3*x - " + time + ")*y")});
    worst = std::max(worst, move.transfer(std::array{f}).report.fields[0].relative_mass_defect);
  }
  std::printf("20 steps, conserved %s\n", worst < 1e-14 ? "yes" : "no");

  // The misfit J = 1/2 |T f - g|^2 on the target has the gradient T* (T f - g) on the donor.
  const Field f = project("f", space, std::array{Formula("x*y")});
  const auto misfit = [&](const Field& moved) {
    const Field g = project("g", move.target_space(), std::array{Formula("y")});
    std::vector<double> c(moved.coefficients().begin(), moved.coefficients().end());
    for (std::size_t i = 0; i < c.size(); ++i) c[i] -= g.coefficients()[i];
    return Field("misfit", move.target_space(), std::move(c));
  };
  const Field gradient = move.apply_adjoint(misfit(move.apply(f)));
  const double slope = l2_norm(gradient) * l2_norm(gradient);
  const auto value = [&](double step) {
    std::vector<double> c(f.coefficients().begin(), f.coefficients().end());
    for (std::size_t i = 0; i < c.size(); ++i) c[i] += step * gradient.coefficients()[i];
    const double size = l2_norm(misfit(move.apply(Field("f", space, std::move(c)))));
    return 0.5 * size * size;
  };
  // J is quadratic, so the difference quotient is exact.
  const double quotient = 0.5 * (value(1.0) - value(-1.0));
  std::printf("gradient as the difference quotient %s\n",
              std::abs(quotient - slope) < 1e-12 * slope ? "yes" : "no");
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  return 3;
}
