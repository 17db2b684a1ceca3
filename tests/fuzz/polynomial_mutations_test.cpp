// The JSON that eval and roots read: numbers in all forms, and seeded mutations of valid texts.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/base/random.hpp"
#include "bezel/numeric/dyadic.hpp"
#include "cli/context.hpp"
#include "cli/polynomials.hpp"
#include "text_mutations.hpp"

namespace bezel::cli {
namespace {

double number(const std::string& text) {
  double value = NAN;
  bool rounded = false;
  return parse_number(text, value, rounded) ? value : NAN;
}

TEST(Numbers, AllForms) {
  EXPECT_EQ(number("1"), 1.0);
  EXPECT_EQ(number("-0.75e2"), -75.0);
  EXPECT_EQ(number("0x1.8p-1"), 0.75);
  EXPECT_EQ(number("-0x1p-1074"), -0x1p-1074);
  EXPECT_EQ(number("3/4"), 0.75);
  EXPECT_EQ(number("-1/3"), -1.0 / 3.0);
  EXPECT_EQ(number("0/7"), 0.0);
  EXPECT_TRUE(std::signbit(number("-0/7")));
  for (const char* bad : {"", "/", "1/", "/2", "1/0", "1/-2", "1/2/3", "1.5/2", "0x1/2", " 1", "1 ",
                          "nan", "inf", "1e999", "0x1p1024", "1,2", "--1", "1/ 2", "half"})
    EXPECT_TRUE(std::isnan(number(bad))) << bad;
  EXPECT_TRUE(std::isnan(number(std::string(301, '1') + "/1")));
  EXPECT_EQ(number(std::string(300, '9') + "/" + std::string(300, '9')), 1.0);
}

// |p/q - x| is at most half the distance to both neighbours, by exact arithmetic; ties to even.
TEST(Numbers, RationalsAreRoundedToNearest) {
  RandomStream random("rationals", 1);
  for (int i = 0; i < 2000; ++i) {
    std::string p, q = "1";
    Dyadic top, bottom(1.0);
    for (std::uint64_t digits = 1 + random.below(60); digits > 0; --digits) {
      const auto d = static_cast<char>('0' + random.below(10));
      p += d;
      top = top * Dyadic(10.0) + Dyadic(double(d - '0'));
    }
    for (std::uint64_t digits = random.below(60); digits > 0; --digits) {
      const auto d = static_cast<char>('0' + random.below(10));
      q += d;
      bottom = bottom * Dyadic(10.0) + Dyadic(double(d - '0'));
    }
    double x = NAN;
    bool rounded = false;
    const std::string text = p + "/" + q;
    ASSERT_TRUE(parse_number(text, x, rounded)) << text;
    EXPECT_EQ(rounded, Dyadic(x) * bottom != top) << text;
    if (top.sign() == 0) continue;
    const Dyadic twice = top.scaled(1);
    const Dyadic low = (Dyadic(x) + Dyadic(std::nextafter(x, 0.0))) * bottom;
    const Dyadic high = (Dyadic(x) + Dyadic(std::nextafter(x, INFINITY))) * bottom;
    EXPECT_FALSE(twice < low) << text;
    EXPECT_FALSE(high < twice) << text;
  }
  // Half way between neighbours: 2^53 + 1 to 2^53, 2^53 + 3 to 2^53 + 4.
  EXPECT_EQ(number("9007199254740993/1"), 9007199254740992.0);
  EXPECT_EQ(number("9007199254740995/1"), 9007199254740996.0);
}

TEST(Numbers, Lists) {
  std::size_t rounded = 0;
  EXPECT_EQ(parse_number_list("--b", "1,-3/4,1/3,0x1p1", rounded),
            (std::vector<double>{1.0, -0.75, 1.0 / 3.0, 2.0}));
  EXPECT_EQ(rounded, 1U);
  for (const char* bad : {"", ",", "1,", "1;2", "1,nan"})
    EXPECT_THROW(parse_number_list("--b", bad, rounded), UsageError) << bad;
}

TEST(Polynomials, LinesAndElements) {
  const auto place = [](const std::string& json) {
    try {
      read_polynomials("f", json, true);
    } catch (const InputError& error) {
      return error.place();
    }
    return InputPlace{};
  };
  EXPECT_EQ(place("[{\"b\":[1],\"s\":0},\n{\"b\":[1,\n2,\nnull]}]").line, 4);
  EXPECT_EQ(place("[{\"b\":[1],\"s\":0},\n{\"b\":[1,\n2,\nnull]}]").element_kind, "object 1, b[2]");
  EXPECT_EQ(place("{\"b\":[1],\n\"s\":[1,\n\"x\"]}").element_kind, "s[1]");
  // A number at the end of its line.
  EXPECT_EQ(place("{\n\"b\":3\n}").line, 2);
  EXPECT_EQ(place("\n\n3\n").line, 3);
}

/// @return whether it was read; test::read_or_refused
bool read(const std::string& json, bool with_parameters) {
  return test::read_or_refused([&] {
    const Polynomials all = read_polynomials("fuzz.json", json, with_parameters);
    if (all.items.empty()) throw std::logic_error("nothing was read");
    for (const Polynomial& p : all.items) {
      if (p.b.empty() || p.b.size() > 61) throw std::logic_error("a wrong degree");
      for (const auto* values : {&p.b, &p.s})
        for (const double v : *values)
          if (!std::isfinite(v)) throw std::logic_error("a number that is not finite");
    }
  });
}

const std::vector<std::string> seeds = {
    "{\"b\": [1, \"-3/4\", \"0x1p-1\", -0.25, 0], \"s\": [0.5, \"0x1.8p-1\", 1e-3]}",
    "[{\"b\": [1, 2],\n \"s\": \"1/3\"},\n {\"s\": [], \"b\": [7]}, {\"b\": [0], \"s\": -2.5E+1}]"};

TEST(PolynomialMutations, OriginalsAreRead) {
  for (const std::string& seed : seeds) {
    EXPECT_TRUE(read(seed, true));
    EXPECT_FALSE(read(seed, false));  // "s" is unknown to roots
  }
}

TEST(PolynomialMutations, EveryTruncationIsRefused) {
  for (const std::string& seed : seeds)
    for (std::size_t n = 0; n < seed.size(); ++n) EXPECT_FALSE(read(seed.substr(0, n), true)) << n;
}

TEST(PolynomialMutations, MutatedTextsAreReadOrRefused) {
  const std::vector<std::string> words = {
      "null", "true",    "1e999", "\"1/0\"", "[", "]", "{",  "}",  ",",      ":",
      "\"",   "\\u0000", "\"b\"", "\"nan\"", "-", "/", "0x", "\n", "1e-999", "18446744073709551616",
      "\xff", "\"s\":"};
  std::size_t i = 0;
  test::try_mutations("polynomial mutations", 50000, seeds, words,
                      [&](const std::string& json) { return read(json, i++ % 3 != 0); });
}

}  // namespace
}  // namespace bezel::cli
