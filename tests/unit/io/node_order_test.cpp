#include "bezel/io/node_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>

#include "bezel/bernstein/index.hpp"
#include "bezel/io/msh.hpp"

namespace bezel::files {
namespace {

// Barycentric indices (i, j, k) of the nodes in file order, recorded from gmsh 4.8.4 (gmsh -2
// -order d on a triangle) and VTK 9.1 (vtkLagrangeTriangle::ToBarycentricIndex); both agree for all
// degrees.
const std::array<const char*, 10> recorded{
    "100 010 001",
    "200 020 002 110 011 101",
    "300 030 003 210 120 021 012 102 201 111",
    "400 040 004 310 220 130 031 022 013 103 202 301 211 121 112",
    "500 050 005 410 320 230 140 041 032 023 014 104 203 302 401 311 131 113 221 122 212",
    "600 060 006 510 420 330 240 150 051 042 033 024 015 105 204 303 402 501 411 141 114 321 231 "
    "132 "
    "123 213 312 222",
    "700 070 007 610 520 430 340 250 160 061 052 043 034 025 016 106 205 304 403 502 601 511 151 "
    "115 "
    "421 331 241 142 133 124 214 313 412 322 232 223",
    "800 080 008 710 620 530 440 350 260 170 071 062 053 044 035 026 017 107 206 305 404 503 602 "
    "701 "
    "611 161 116 521 431 341 251 152 143 134 125 215 314 413 512 422 242 224 332 233 323",
    "900 090 009 810 720 630 540 450 360 270 180 081 072 063 054 045 036 027 018 108 207 306 405 "
    "504 "
    "603 702 801 711 171 117 621 531 441 351 261 162 153 144 135 126 216 315 414 513 612 522 252 "
    "225 "
    "432 342 243 234 324 423 333",
    "a00 0a0 00a 910 820 730 640 550 460 370 280 190 091 082 073 064 055 046 037 028 019 109 208 "
    "307 "
    "406 505 604 703 802 901 811 181 118 721 631 541 451 361 271 172 163 154 145 136 127 217 316 "
    "415 "
    "514 613 712 622 262 226 532 442 352 253 244 235 325 424 523 433 343 334"};

TEST(TriangleOrder, IsThatOfGmshAndVtkAtEveryDegree) {
  for (int d = 1; d <= 10; ++d) {
    std::string text;
    for (const int n : triangle_order(d)) {
      text += text.empty() ? "" : " ";
      for (const int index : bernstein::triangle_multi_index(d, n)) text += "0123456789a"[index];
    }
    EXPECT_EQ(text, recorded[static_cast<std::size_t>(d - 1)]) << "degree " << d;
  }
}

TEST(LineOrder, EndsComeFirst) {
  EXPECT_EQ(line_order(1), (std::vector<int>{0, 1}));
  EXPECT_EQ(line_order(4), (std::vector<int>{0, 4, 1, 2, 3}));
}

TEST(MshTypes, AreThoseOfTheManual) {
  constexpr std::array<int, 10> triangles{2, 9, 21, 23, 25, 42, 43, 44, 45, 46};
  constexpr std::array<int, 10> lines{1, 8, 26, 27, 28, 62, 63, 64, 65, 66};
  for (int d = 1; d <= 10; ++d) {
    const auto i = static_cast<std::size_t>(d - 1);
    EXPECT_EQ(msh_triangle_type(d), triangles[i]);
    EXPECT_EQ(msh_line_type(d), lines[i]);
    ASSERT_NE(msh_type(triangles[i]), nullptr);
    EXPECT_EQ(msh_type(triangles[i])->nodes, bernstein::triangle_size(d));
    EXPECT_EQ(msh_type(triangles[i])->degree, d);
    EXPECT_EQ(msh_type_name(triangles[i]),
              std::to_string(bernstein::triangle_size(d)) + "-node triangle");
    EXPECT_EQ(msh_type_name(lines[i]), std::to_string(d + 1) + "-node line");
  }
  EXPECT_EQ(msh_type(3), nullptr);
  EXPECT_EQ(msh_type_name(3), "4-node quadrangle");
  EXPECT_EQ(msh_type_name(12345), "unknown");
}

// The scheme's functions are 1 at their node and 0 at the others; evaluating the monomials of
// degree 10 cancels about 9 digits.
TEST(NodalScheme, InterpolatesTheNodes) {
  for (int d = 1; d <= 10; ++d) {
    const InterpolationScheme scheme = nodal_scheme(d);
    const std::vector<int> order = triangle_order(d);
    ASSERT_EQ(scheme.functions, order.size());
    double largest = 0.0;
    for (const double c : scheme.coefficients) largest = std::max(largest, std::abs(c));
    for (std::size_t n = 0; n < order.size(); ++n) {
      const auto index = bernstein::triangle_multi_index(d, order[n]);
      const double u = double(index[1]) / d, v = double(index[2]) / d;
      for (std::size_t i = 0; i < scheme.functions; ++i) {
        double sum = 0.0;
        for (std::size_t m = 0; m < scheme.monomials; ++m)
          sum += scheme.coefficients[i * scheme.monomials + m] *
                 std::pow(u, scheme.exponents[3 * m]) * std::pow(v, scheme.exponents[3 * m + 1]);
        EXPECT_NEAR(sum, i == n ? 1.0 : 0.0, 1e-15 * largest) << d << " " << i << " " << n;
      }
    }
  }
}

TEST(NodalScheme, HasTheKnownEntriesOfDegreeTwo) {
  const InterpolationScheme scheme = nodal_scheme(2);
  // Monomials 1 u u^2 v uv v^2; functions of nodes 200 020 002 110 011 101.
  EXPECT_EQ(scheme.coefficients,
            (std::vector<double>{1, -3, 2,  -3, 4,  2, 0, -1, 2, 0, 0, 0, 0, 0, 0, -1, 0,  2,
                                 0, 4,  -4, 0,  -4, 0, 0, 0,  0, 0, 4, 0, 0, 0, 0, 4,  -4, -4}));
  EXPECT_EQ(scheme.exponents,
            (std::vector<double>{0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0}));
}

}  // namespace
}  // namespace bezel::files
