#include "bezel/field/element_kernel.hpp"

namespace bezel::field_detail {
namespace {

constexpr int largest_table_degree = 80;  // of triangle_rule

TriangleRule collapsed_rule(int degree) {
  const IntervalRule gauss =
      gauss_legendre(degree / 2 + 1);  // 2n-1 >= degree + 1 needs n >= degree/2 + 1
  TriangleRule rule;
  for (int a = 0; a < gauss.size(); ++a)
    for (int b = 0; b < gauss.size(); ++b) {
      const double u = gauss.node[static_cast<std::size_t>(a)];
      const double t = gauss.node[static_cast<std::size_t>(b)];
      const double v = (1.0 - u) * t;
      rule.lambda.push_back({(1.0 - u) * (1.0 - t), u, v});
      rule.weight.push_back(gauss.weight[static_cast<std::size_t>(a)] *
                            gauss.weight[static_cast<std::size_t>(b)] * (1.0 - u));
    }
  return rule;
}

}  // namespace

TriangleRule rule_of_degree(int degree) {
  return degree <= largest_table_degree ? triangle_rule(degree) : collapsed_rule(degree);
}

std::vector<int> degrees_of(const Space& space) {
  if (space.uniform_degree() >= 0) return {space.uniform_degree()};
  std::array<bool, static_cast<std::size_t>(Space::max_degree) + 1> used{};
  for (std::size_t e = 0; e < space.mesh()->element_count(); ++e)
    used[static_cast<std::size_t>(space.degree(ElementId(e)))] = true;
  std::vector<int> degrees;
  for (int p = 0; p <= Space::max_degree; ++p)
    if (used[static_cast<std::size_t>(p)]) degrees.push_back(p);
  return degrees;
}

RuleTable::RuleTable(const Space& space, const std::function<int(int)>& degree_of) {
  for (const int p : degrees_of(space))
    rule_[static_cast<std::size_t>(p)] = rule_of_degree(degree_of(p));
}

}  // namespace bezel::field_detail
