#include "cli/json_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bezel/base/error.hpp"
#include "bezel/io/cursor.hpp"
#include "cli/polynomials.hpp"

namespace bezel::cli {

void JsonFields::fail(const JsonValue& at, const std::string& where,
                      const std::string& message) const {
  throw InputError(InputPlace{file_, at.line, where, -1}, message);
}

void JsonFields::check_object(const JsonValue& value, const std::string& where) const {
  if (value.kind != JsonValue::Kind::object)
    fail(value, where, fmt::format("found {}, expected an object", described(value)));
}

void JsonFields::check_keys(const JsonValue& object, const std::string& where,
                            std::initializer_list<const char*> known) const {
  for (std::size_t i = 0; i < object.keys.size(); ++i) {
    if (std::any_of(known.begin(), known.end(),
                    [&](const char* key) { return object.keys[i] == key; }))
      continue;
    std::string listed;
    for (const char* key : known)
      listed += fmt::format("{}\"{}\"", listed.empty() ? "" : ", ", key);
    fail(object.items[i], where,
         fmt::format("unknown key \"{}\", expected {}", files::shown(object.keys[i]), listed));
  }
}

const JsonValue& JsonFields::required(const JsonValue& object, const std::string& where,
                                      const char* key) const {
  const JsonValue* value = object.find(key);
  if (!value) fail(object, where, fmt::format("the key \"{}\" is missing", key));
  return *value;
}

double JsonFields::number(const JsonValue& value, const std::string& where) {
  double x = value.number;
  if (value.kind == JsonValue::Kind::string) {
    bool rounded = false;
    if (parse_number(value.text, x, rounded)) {
      if (rounded) ++rounded_;
      return x;
    }
  } else if (value.kind == JsonValue::Kind::number) {
    if (std::isfinite(x)) return x;
    fail(value, where, "found a number beyond the range of doubles, expected a finite one");
  }
  fail(value, where, fmt::format("found {}, expected {}", described(value), number_forms));
}

std::vector<double> JsonFields::numbers(const JsonValue& list, const std::string& where) {
  if (list.kind != JsonValue::Kind::array)
    fail(list, where, fmt::format("found {}, expected an array of numbers", described(list)));
  std::vector<double> out;
  for (std::size_t i = 0; i < list.items.size(); ++i)
    out.push_back(number(list.items[i], fmt::format("{}[{}]", where, i)));
  return out;
}

int JsonFields::whole(const JsonValue& value, const std::string& where, const char* what, int least,
                      int most) const {
  if (value.kind != JsonValue::Kind::number || !(value.number >= least && value.number <= most) ||
      value.number != std::floor(value.number))
    fail(value, where,
         fmt::format("{}: found {}, expected a whole number from {} to {}", what,
                     value.kind == JsonValue::Kind::number ? fmt::format("{}", value.number)
                                                           : described(value),
                     least, most));
  return static_cast<int>(value.number);
}

bool JsonFields::boolean(const JsonValue& value, const std::string& where, const char* what) const {
  if (value.kind != JsonValue::Kind::boolean)
    fail(value, where, fmt::format("{}: found {}, expected true or false", what, described(value)));
  return value.number != 0.0;
}

const std::string& JsonFields::string(const JsonValue& value, const std::string& where,
                                      const char* what) const {
  if (value.kind != JsonValue::Kind::string)
    fail(value, where, fmt::format("{}: found {}, expected a string", what, described(value)));
  return value.text;
}

std::vector<std::vector<double>> JsonFields::coordinates(const JsonValue& lists,
                                                         const std::string& where,
                                                         std::size_t least, std::size_t most) {
  const char* form =
      most == 2 ? "expected [[x, ...], [y, ...]]" : "expected [[x, ...], [y, ...], [z, ...]]";
  if (lists.kind != JsonValue::Kind::array)
    fail(lists, where, fmt::format("found {}, {}", described(lists), form));
  const std::size_t dim = lists.items.size();
  if (dim < least || dim > most)
    fail(lists, where, fmt::format("found an array of {}, {}", dim, form));
  for (const JsonValue& list : lists.items)
    if (list.kind != JsonValue::Kind::array)
      fail(list, where, fmt::format("found {}, {}", described(list), form));
  const std::size_t n = lists.items[0].items.size();
  constexpr const char* names = "xyz";
  for (std::size_t c = 1; c < dim; ++c)
    if (lists.items[c].items.size() != n)
      fail(lists, where,
           fmt::format("found {} x and {} {} coordinates, expected as many", n,
                       lists.items[c].items.size(), names[c]));
  std::vector<std::vector<double>> out(dim);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t c = 0; c < dim; ++c)
      out[c].push_back(
          number(lists.items[c].items[i], fmt::format("{}, point {}, {}", where, i, names[c])));
  return out;
}

}  // namespace bezel::cli
