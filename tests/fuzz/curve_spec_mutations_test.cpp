// The JSON that curve and mesh --curve read: every form, and seeded mutations of valid texts.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/base/random.hpp"
#include "cli/curve_spec.hpp"
#include "text_mutations.hpp"

namespace bezel::cli {
namespace {

const std::vector<std::string> seeds = {
    "{\"formula\": {\"x\": \"cos(t)\", \"y\": \"t*t\", \"z\": \"2*t\", \"from\": 0, \"to\": "
    "\"pi/2\", \"breaks\": [1]}}",
    "[{\"shape\": \"naca 2412 upper chord=2\", \"scale\": 2, \"rotate\": \"pi/3\", \"translate\": "
    "[1, -1]},\n {\"shape\": \"clothoid k0=-1 k1=2 length=3\", \"reverse\": true, \"name\": "
    "\"c\"}]",
    "{\"bezier\": {\"control\": [[0, 1, \"1/2\"], [0, 1, 0]], \"weights\": [1, \"0x1p-1\", 1]}}",
    "{\"curves\": [{\"nurbs\": {\"degree\": 2, \"knots\": [0, 0, 0, 1, 2, 2, 2],\n \"control\": "
    "[[0, 1, 2, 3], [0, 1, -1, 0]], \"weights\": [1, 2, 1, 1]}}]}",
    "{\"points\": {\"coordinates\": [[1, 0, -1], [0, 1, 0]], \"ends\": \"closed\", \"parameter\": "
    "\"chord\"}}",
    "{\"shape\": \"superellipse n=3 a=2 from=0.1 to=3\"}",
    "{\"shape\": \"polynomial x=0,1,2 y=1,2 from=-1\"}"};

/// @return whether it was read; anything but InputError with one line is thrown on
bool read(const std::string& json) {
  try {
    const CurveSpecs all = read_curve_specs("fuzz.json", json);
    if (all.curves.empty()) throw std::logic_error("nothing was read");
    for (const CurveSpec& spec : all.curves) {
      if (spec.plane.has_value() == spec.space.has_value()) throw std::logic_error("no one curve");
      const double length = spec.plane ? spec.plane->length() : spec.space->length();
      if (!(length > 0.0) || !std::isfinite(length)) throw std::logic_error("no length");
    }
    return true;
  } catch (const InputError& error) {
    const std::string what = error.what();
    if (what.rfind("fuzz.json:", 0) != 0) throw std::logic_error("no place: " + what);
    for (const char c : what)
      if (static_cast<unsigned char>(c) < 32) throw std::logic_error("several lines: " + what);
    return false;
  }
}

TEST(CurveSpecs, SeedsAreRead) {
  for (const std::string& seed : seeds) EXPECT_TRUE(read(seed)) << seed;
}

TEST(CurveSpecMutations, MutatedTextsAreReadOrRefused) {
  const std::vector<std::string> words = {"null",    "true",        "1e999",
                                          "\"1/0\"", "[",           "]",
                                          "{",       "}",           ",",
                                          ":",       "\"",          "\\u0000",
                                          "\"\"",    "nan",         "-",
                                          "\n",      "1e-999",      "\xff",
                                          "1e300",   "1e-300",      "t",
                                          "^9",      "/0",          "sqrt(",
                                          "=",       " ",           "\"reverse\":true,",
                                          "[0, 0]",  "from=1 ",     "0",
                                          "upper",   "\"weights\":"};
  constexpr std::uint64_t seed_number = 20261128;
  RandomStream random("curve spec mutations", seed_number);
  std::size_t refused = 0;
  constexpr std::size_t tries = 4000;
  for (std::size_t i = 0; i < tries; ++i) {
    const std::string json = test::mutated(seeds[i % seeds.size()], words, random);
    try {
      refused += read(json) ? 0 : 1;
    } catch (const std::exception& error) {
      FAIL() << "mutation " << i << " of seed " << seed_number << ": " << error.what() << "\n"
             << json;
    }
  }
  EXPECT_GT(refused, tries / 4);
  EXPECT_GT(tries - refused, tries / 100);
}

}  // namespace
}  // namespace bezel::cli
