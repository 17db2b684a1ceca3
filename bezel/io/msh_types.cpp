#include <array>
#include <cstdint>

#include "bezel/bernstein/index.hpp"
#include "bezel/io/msh.hpp"
#include "bezel/io/node_order.hpp"

namespace bezel::files {
namespace {

// Gmsh 4.8 reference manual, section 9.1 and src/common/GmshDefines.h.
constexpr std::array<MshType, 21> types{{
    {15, 0, 0, 1},   {1, 1, 1, 2},   {8, 1, 2, 3},   {26, 1, 3, 4},  {27, 1, 4, 5},
    {28, 1, 5, 6},   {62, 1, 6, 7},  {63, 1, 7, 8},  {64, 1, 8, 9},  {65, 1, 9, 10},
    {66, 1, 10, 11}, {2, 2, 1, 3},   {9, 2, 2, 6},   {21, 2, 3, 10}, {23, 2, 4, 15},
    {25, 2, 5, 21},  {42, 2, 6, 28}, {43, 2, 7, 36}, {44, 2, 8, 45}, {45, 2, 9, 55},
    {46, 2, 10, 66},
}};

struct TypeName {
  int type;
  const char* name;
};
constexpr std::array<TypeName, 52> names{{
    {1, "2-node line"},          {2, "3-node triangle"},
    {3, "4-node quadrangle"},    {4, "4-node tetrahedron"},
    {5, "8-node hexahedron"},    {6, "6-node prism"},
    {7, "5-node pyramid"},       {8, "3-node line"},
    {9, "6-node triangle"},      {10, "9-node quadrangle"},
    {11, "10-node tetrahedron"}, {12, "27-node hexahedron"},
    {13, "18-node prism"},       {14, "14-node pyramid"},
    {15, "1-node point"},        {16, "8-node quadrangle"},
    {17, "20-node hexahedron"},  {18, "15-node prism"},
    {19, "13-node pyramid"},     {20, "9-node triangle"},
    {21, "10-node triangle"},    {22, "12-node triangle"},
    {23, "15-node triangle"},    {24, "15-node triangle, incomplete"},
    {25, "21-node triangle"},    {26, "4-node line"},
    {27, "5-node line"},         {28, "6-node line"},
    {29, "20-node tetrahedron"}, {30, "35-node tetrahedron"},
    {31, "56-node tetrahedron"}, {34, "polygon"},
    {35, "polyhedron"},          {36, "16-node quadrangle"},
    {37, "25-node quadrangle"},  {38, "36-node quadrangle"},
    {39, "12-node quadrangle"},  {40, "16-node quadrangle, incomplete"},
    {41, "20-node quadrangle"},  {42, "28-node triangle"},
    {43, "36-node triangle"},    {44, "45-node triangle"},
    {45, "55-node triangle"},    {46, "66-node triangle"},
    {47, "49-node quadrangle"},  {48, "64-node quadrangle"},
    {49, "81-node quadrangle"},  {50, "100-node quadrangle"},
    {51, "121-node quadrangle"}, {52, "18-node triangle, incomplete"},
    {92, "64-node hexahedron"},  {93, "125-node hexahedron"},
}};

/// A polynomial in u and v with integer coefficients, entry (a, b) of u^a v^b.
class IntegerPolynomial {
 public:
  explicit IntegerPolynomial(int degree) : n_(degree + 1) {
    c_.assign(static_cast<std::size_t>(n_) * static_cast<std::size_t>(n_), 0);
    c_[0] = 1;
  }
  std::int64_t& at(int a, int b) { return c_[static_cast<std::size_t>(a * n_ + b)]; }
  /// Times (constant + u_factor u + v_factor v).
  void multiply(std::int64_t constant, std::int64_t u_factor, std::int64_t v_factor) {
    for (int a = n_ - 1; a >= 0; --a)
      for (int b = n_ - 1; b >= 0; --b) {
        std::int64_t sum = constant * at(a, b);
        if (a > 0) sum += u_factor * at(a - 1, b);
        if (b > 0) sum += v_factor * at(a, b - 1);
        at(a, b) = sum;
      }
  }

 private:
  int n_;
  std::vector<std::int64_t> c_;
};

}  // namespace

const MshType* msh_type(int type) {
  for (const MshType& t : types)
    if (t.type == type) return &t;
  return nullptr;
}

int msh_line_type(int degree) {
  return types[static_cast<std::size_t>(degree)].type;
}
int msh_triangle_type(int degree) {
  return types[static_cast<std::size_t>(10 + degree)].type;
}

std::string msh_type_name(int type) {
  for (const TypeName& t : names)
    if (t.type == type) return t.name;
  return msh_type(type) ? std::to_string(msh_type(type)->nodes) + "-node line" : "unknown";
}

InterpolationScheme nodal_scheme(int degree) {
  InterpolationScheme scheme;
  const auto size = static_cast<std::size_t>(bernstein::triangle_size(degree));
  scheme.functions = scheme.monomials = size;
  for (std::size_t j = 0; j < size; ++j) {  // the monomials in the order of bernstein/index.hpp
    const auto index = bernstein::triangle_multi_index(degree, static_cast<int>(j));
    for (const int power : {index[1], index[2], 0})
      scheme.exponents.push_back(static_cast<double>(power));
  }
  const std::vector<int> order = degree == 0 ? std::vector<int>{0} : triangle_order(degree);
  for (const int n : order) {
    // Silvester: product over the three lambda of P_m(lambda) = 1/m! prod_{r<m} (d lambda - r).
    // Integer coefficients: at most prod_{r<10} (30 + r) = 2.3e15 fit 64 bits.
    const auto [i, j, k] = bernstein::triangle_multi_index(degree, n);
    IntegerPolynomial p(degree);
    std::int64_t denominator = 1;
    for (int r = 0; r < i; ++r) p.multiply(degree - r, -degree, -degree), denominator *= r + 1;
    for (int r = 0; r < j; ++r) p.multiply(-r, degree, 0), denominator *= r + 1;
    for (int r = 0; r < k; ++r) p.multiply(-r, 0, degree), denominator *= r + 1;
    for (std::size_t m = 0; m < size; ++m) {
      const auto a = static_cast<int>(scheme.exponents[3 * m]);
      const auto b = static_cast<int>(scheme.exponents[3 * m + 1]);
      scheme.coefficients.push_back(static_cast<double>(p.at(a, b)) /
                                    static_cast<double>(denominator));
    }
  }
  return scheme;
}

}  // namespace bezel::files
