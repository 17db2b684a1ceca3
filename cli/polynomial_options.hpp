#pragma once
// What eval and roots share: where polynomials come from, and how lists of results are printed.

#include <string>

#include "cli/command.hpp"
#include "cli/output.hpp"
#include "cli/polynomials.hpp"

namespace bezel::cli {

struct PolynomialOptions {
  std::string file, coefficients;
};

/// Adds FILE and --b.
void add_polynomial_options(CLI::App& command, PolynomialOptions& options);

/// The polynomials of FILE ("-": the standard input) or of --b; notes how many rationals were
/// rounded. @param parameters  the text of --s; null when the command takes no parameters
/// @throws  UsageError when not exactly one of FILE and --b is given, or --s without --b;
///          InputError for what is in them
Polynomials read_input(const PolynomialOptions& options, const std::string* parameters,
                       const Context& context);

/// Doubles; with hex as strings. Not finite: null.
Json numbers_json(const std::vector<double>& values, bool hex);
Json number_json(double value, bool hex);

/// "polynomial i" above the i-th table of a list, with an empty line between two; else nothing.
std::string heading(const Polynomials& input, std::size_t i);

/// One object: of the only result, or with "results" for a list.
std::string results_text(const std::string& schema, bool list, const Json& results);

}  // namespace bezel::cli
