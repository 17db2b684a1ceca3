#pragma once
// Arguments that are more than a number or a word.

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bezel/field/space.hpp"
#include "bezel/formula/formula.hpp"
#include "bezel/io/io.hpp"
#include "cli/command.hpp"

namespace bezel::cli {

/// A whole text as a finite number, or nothing.
std::optional<double> parse_number(std::string_view text);

/// "LO,HI" or "X,Y". @throws UsageError "--center: expected two numbers such as 0.5,-1, found '…'"
std::pair<double, double> parse_pair(const std::string& option, const std::string& text);

/// Formulas in x and y separated by semicolons, one per component.
/// @throws InputError "<what>: column …", with the component when there are several
std::vector<Formula> parse_components(const std::string& what, const std::string& text);

/// "NAME=EXPR[;EXPR2]".
struct NamedFormulas {
  std::string name;
  std::vector<Formula> components;
};
/// @throws UsageError when there is no name; InputError for a formula
NamedFormulas parse_named_formulas(const std::string& text);

/// Adds --format for the file written (or read). The words are those of bezel::to_string(Format).
void add_format_option(CLI::App& command, std::optional<Format>& format, const std::string& name,
                       const std::string& what);
/// Adds --basis reference|physical.
CLI::Option* add_basis_option(CLI::App& command, Basis& basis, const std::string& what);

std::string to_string(Basis basis);
std::string to_string(Continuity continuity);

}  // namespace bezel::cli
