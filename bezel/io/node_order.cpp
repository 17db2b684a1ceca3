#include "bezel/io/node_order.hpp"

#include "bezel/bernstein/index.hpp"

namespace bezel::files {

std::vector<int> triangle_order(int degree) {
  using bernstein::triangle_index;
  std::vector<int> order;
  order.reserve(static_cast<std::size_t>(bernstein::triangle_size(degree)));
  // (i, j, k) of the nested triangle of degree d is (i, j, k) + inset of the whole one.
  int inset = 0;
  for (int d = degree; d >= 0; d -= 3, ++inset) {
    const auto add = [&](int j, int k) {
      order.push_back(triangle_index(degree, j + inset, k + inset));
    };
    add(0, 0);
    if (d == 0) break;
    add(d, 0);
    add(0, d);
    for (int m = 1; m < d; ++m) add(m, 0);
    for (int m = 1; m < d; ++m) add(d - m, m);
    for (int m = 1; m < d; ++m) add(0, d - m);
  }
  return order;
}

std::vector<int> line_order(int degree) {
  std::vector<int> order{0, degree};
  for (int m = 1; m < degree; ++m) order.push_back(m);
  return order;
}

}  // namespace bezel::files
