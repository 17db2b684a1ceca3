#include <set>

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

RuleTable::RuleTable(const Space& space, const std::function<int(int)>& degree_of) {
  std::set<int> degrees;
  if (space.uniform_degree() >= 0)
    degrees.insert(space.uniform_degree());
  else
    for (std::size_t e = 0; e < space.mesh()->element_count(); ++e)
      degrees.insert(space.degree(ElementId(e)));
  for (const int p : degrees) rule_[static_cast<std::size_t>(p)] = rule_of_degree(degree_of(p));
}

}  // namespace bezel::field_detail
