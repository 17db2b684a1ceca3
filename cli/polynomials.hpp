#pragma once
// Polynomials as the commands eval and roots read them: JSON, or lists on the command line.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace bezel::cli {

/// What a number may look like, for messages.
inline constexpr const char* number_forms = "a number, \"p/q\" or a hex float such as \"0x1.8p-1\"";

/// Reads one whole number: decimal "-0.75e2", hex float "0x1.8p-1" or rational "-1/3" (integers of
/// at most 300 digits), each the nearest double, ties to even. False when the text is anything else
/// or out of the range of a double. @param rounded  set when a rational is no double
bool parse_number(std::string_view text, double& value, bool& rounded);

struct Polynomial {
  std::vector<double> b;  ///< Bernstein coefficients, 1 to 61, finite
  std::vector<double> s;  ///< parameters, finite; empty when none are read
};

struct Polynomials {
  std::string name;  ///< of the input, for messages
  std::vector<Polynomial> items;
  bool list = false;        ///< whether the input was a list
  std::size_t rounded = 0;  ///< how many rationals are no doubles and were rounded
};

/// Reads {"b": [...], "s": [...]} or a list of such objects from JSON. A number is a JSON number or
/// a string that parse_number reads; s may be a single number.
///
/// @param name  of the file, for messages
/// @param with_parameters  whether "s" is required (or unknown)
/// @throws  InputError with file, line and element ("object 2, b[3]", both from 0)
Polynomials read_polynomials(const std::string& name, std::string_view json, bool with_parameters);

/// Numbers separated by commas, at least one.
/// @throws UsageError "--b: ..."; @param rounded  counts rationals that were rounded
std::vector<double> parse_number_list(const std::string& option, std::string_view text,
                                      std::size_t& rounded);

}  // namespace bezel::cli
