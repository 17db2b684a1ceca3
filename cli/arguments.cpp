#include "cli/arguments.hpp"

#include <charconv>
#include <cmath>
#include <map>

#include "bezel/base/error.hpp"

namespace bezel::cli {

std::optional<double> parse_number(std::string_view text) {
  if (!text.empty() && text[0] == '+') text.remove_prefix(1);
  double value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc{} || result.ptr != text.data() + text.size() || !std::isfinite(value))
    return {};
  return value;
}

std::pair<double, double> parse_pair(const std::string& option, const std::string& text) {
  const auto comma = text.find(',');
  if (comma != std::string::npos) {
    const auto first = parse_number(std::string_view(text).substr(0, comma));
    const auto second = parse_number(std::string_view(text).substr(comma + 1));
    if (first && second) return {*first, *second};
  }
  throw UsageError(option + ": expected two numbers such as 0.5,-1, found '" + text + "'");
}

std::vector<Formula> parse_components(const std::string& what, const std::string& text) {
  std::vector<Formula> components;
  const bool several = text.find(';') != std::string::npos;
  for (std::size_t start = 0;;) {
    const auto end = std::min(text.find(';', start), text.size());
    try {
      components.emplace_back(std::string_view(text).substr(start, end - start));
    } catch (const InputError& error) {
      InputPlace place;
      place.element_kind = what;
      if (several) place.element_kind += ", component " + std::to_string(components.size());
      throw InputError(place, error.what());
    }
    if (end == text.size()) return components;
    start = end + 1;
  }
}

NamedFormulas parse_named_formulas(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw UsageError("-f: expected NAME=EXPR, found '" + text + "'");
  }
  const std::string name = text.substr(0, equals);
  return {name, parse_components("field " + name, text.substr(equals + 1))};
}

void add_format_option(CLI::App& command, std::optional<Format>& format, const std::string& name,
                       const std::string& what) {
  static const std::map<std::string, Format> formats = [] {
    std::map<std::string, Format> all;
    for (const Format f : {Format::msh22_ascii, Format::msh22_binary, Format::msh41_ascii,
                           Format::msh41_binary, Format::vtu, Format::native}) {
      all[bezel::to_string(f)] = f;
    }
    return all;
  }();
  std::vector<std::string> words;
  for (const auto& entry : formats) words.push_back(entry.first);
  command
      .add_option_function<std::string>(
          name, [&format](const std::string& word) { format = formats.at(word); }, what)
      ->check(CLI::IsMember(words))
      ->type_name("FORMAT");
}

CLI::Option* add_basis_option(CLI::App& command, Basis& basis, const std::string& what) {
  return command
      .add_option_function<std::string>(
          "--basis",
          [&basis](const std::string& word) {
            basis = word == "physical" ? Basis::physical : Basis::reference;
          },
          what)
      ->check(CLI::IsMember({"reference", "physical"}))
      ->type_name("BASIS");
}

std::string to_string(Basis basis) {
  return basis == Basis::physical ? "physical" : "reference";
}
std::string to_string(Continuity continuity) {
  return continuity == Continuity::continuous ? "continuous" : "discontinuous";
}

}  // namespace bezel::cli
