// The deformed domains of [bjontegaard2009, sec. 3] against an independent prototype, and the
// errors that equal tangents should reach.

#include <gtest/gtest.h>

#include <cmath>

#include "bezel/solve/spectral.hpp"
#include "cli/domain_cases.hpp"
#include "cli/domain_reference.hpp"

namespace bezel {
namespace {

double u(double x, double y) {
  return std::exp(x) * std::sin(y);
}
Vec2 grad(double x, double y) {
  return {std::exp(x) * std::sin(y), std::exp(x) * std::cos(y)};
}

struct Domains : testing::Test {
  const std::array<cli::DomainCase, 3> domains = cli::domain_cases();
  const CurveInterpolator interpolator{24};
  GordonHall map(int domain, int degree, CurveMethod method) const {
    return gordon_hall(domains[static_cast<std::size_t>(domain) - 1].curves, degree, method,
                       interpolator);
  }
  double area_error(int domain, const GordonHall& at) const {
    return std::fabs(at.area() - domains[static_cast<std::size_t>(domain) - 1].area);
  }
};

TEST_F(Domains, NodesPlacedByFormulaGiveThePrototypesErrors) {
  // Three digits, and rounding: the errors of the area are differences of numbers of size 2.
  const CurveMethod methods[] = {CurveMethod::standard, CurveMethod::chord,
                                 CurveMethod::arc_length};
  for (int domain = 1; domain <= 3; ++domain)
    for (const int degree : {4, 8, 14})
      for (int m = 0; m < 3; ++m) {
        const GordonHall at = map(domain, degree, methods[m]);
        const cli::DomainErrors expected = cli::domain_reference(domain, degree, m);
        EXPECT_NEAR(area_error(domain, at), expected.area, 0.006 * expected.area + 4e-15);
        EXPECT_NEAR(solve_poisson(at, {u}).errors(u, grad).energy, expected.energy,
                    0.006 * expected.energy);
      }
}

TEST_F(Domains, EqualTangentsGiveThePrototypesErrors) {
  // On the first two domains, where one root is best by far.
  for (int domain = 1; domain <= 2; ++domain)
    for (const int degree : {4, 8, 14}) {
      const GordonHall at = map(domain, degree, CurveMethod::equal_tangent);
      const cli::DomainErrors expected = cli::domain_reference(domain, degree, 4);
      EXPECT_NEAR(area_error(domain, at), expected.area, 0.006 * expected.area + 4e-15);
      EXPECT_NEAR(solve_poisson(at, {u}).errors(u, grad).energy, expected.energy,
                  0.006 * expected.energy);
    }
}

TEST_F(Domains, EqualTangentsReachRoundingInTheAreaAtDegree18) {
  for (int domain = 1; domain <= 3; ++domain) {
    const GordonHall at = map(domain, 18, CurveMethod::equal_tangent);
    EXPECT_LE(area_error(domain, at), 1e-14) << domain;
    EXPECT_EQ(check_quad_validity(18, at.control()).status, Validity::valid) << domain;
  }
}

TEST_F(Domains, EqualTangentsReachTheEnergyErrorsAtDegree24) {
  const double goal[] = {5e-5, 4e-7, 4e-5};
  for (int domain = 1; domain <= 2; ++domain)
    EXPECT_LE(
        solve_poisson(map(domain, 24, CurveMethod::equal_tangent), {u}).errors(u, grad).energy,
        goal[domain - 1])
        << domain;
}

}  // namespace
}  // namespace bezel
