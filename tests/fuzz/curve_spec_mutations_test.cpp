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

/// @return whether it was read; test::read_or_refused
bool read(const std::string& json) {
  return test::read_or_refused([&] {
    const CurveSpecs all = read_curve_specs("fuzz.json", json);
    if (all.curves.empty()) throw std::logic_error("nothing was read");
    for (const CurveSpec& spec : all.curves) {
      if (spec.plane.has_value() == spec.space.has_value()) throw std::logic_error("no one curve");
      const double length = spec.plane ? spec.plane->length() : spec.space->length();
      if (!(length > 0.0) || !std::isfinite(length)) throw std::logic_error("no length");
    }
  });
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
  test::try_mutations("curve spec mutations", 4000, seeds, words, read);
}

}  // namespace
}  // namespace bezel::cli
