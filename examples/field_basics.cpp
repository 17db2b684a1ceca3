// Spaces and fields: make them from formulas, evaluate them, integrate them, measure their error.
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>

#include "bezel/field/field.hpp"
#include "bezel/mesh/generate.hpp"

int main() {
  using namespace bezel;
  GenerateOptions options;
  options.degree = 3;  // cubic triangles: the boundary is curved
  options.size = 0.4;
  const auto disc = std::make_shared<const TriangleMesh>(generate_disc(1.0, options));

  // The same formula in three spaces of degree 4.
  const std::array formula{Formula("exp(x) * cos(3*y)")};
  const Field mapped = project("f", Space::discontinuous(disc, 4, Basis::reference), formula);
  const Field plain = project("f", Space::discontinuous(disc, 4, Basis::physical), formula);
  const Field smooth = project("f", Space::continuous(disc, 4), formula);
  for (const Field* field : {&mapped, &plain, &smooth}) {
    const ErrorNorms error = error_norms(*field, formula);
    const bernstein::Range range = value_range(*field, 0);
    std::printf("%6zu dofs: error %s 0.001, range within [%.1f, %.1f]\n",
                field->space().dof_count(), error.l2_relative < 1e-3 ? "below" : "above",
                range.lo - 0.05, range.hi + 0.05);
  }

  // A polynomial in x and y belongs to the physical basis even on curved triangles: its integral is
  // exact.
  const Field square =
      sample("x^2", Space::discontinuous(disc, 2, Basis::physical), std::array{Formula("x^2")});
  const Field one = sample("1", Space::discontinuous(disc, 0), std::array{Formula("1 + 0*x*y")});
  std::printf("area %.4f, second moment %.4f\n", integral(one)[0], integral(square)[0]);

  // Values anywhere in the plane; NaN outside the mesh.
  const FieldEvaluator at(plain);
  const std::array<Vec2, 2> points{Vec2{0.3, -0.2}, Vec2{2.0, 0.0}};
  std::array<double, 2> values{};
  at.evaluate(points, values);
  std::printf("f(0.3, -0.2) = %.4f, outside: %s\n", values[0], std::isnan(values[1]) ? "NaN" : "?");
}
