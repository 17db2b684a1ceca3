#include "cli/polynomials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/index.hpp"
#include "bezel/io/cursor.hpp"
#include "bezel/numeric/dyadic.hpp"
#include "cli/context.hpp"
#include "cli/json_text.hpp"

namespace bezel::cli {
namespace {

using files::shown;

constexpr std::size_t most_digits = 300;

/// Digits as an integer; nothing when there are none, too many, or other characters.
std::optional<Dyadic> parse_digits(std::string_view text) {
  if (text.empty() || text.size() > most_digits) return {};
  Dyadic value;
  for (const char c : text) {
    if (c < '0' || c > '9') return {};
    value = value * Dyadic(10.0) + Dyadic(double(c - '0'));
  }
  return value;
}

/// p / q, p >= 0 and q > 0 below 1e300, to nearest, ties to even.
double quotient(const Dyadic& p, const Dyadic& q) {
  if (p.sign() == 0) return 0.0;
  // Within two places of the quotient, which is normal: 1e-300 to 1e300.
  double x = p.to_double() / q.to_double();
  const auto above_half_way = [&](double low, double high) {  // sign of 2 p / q - (low + high)
    return (p.scaled(1) - (Dyadic(low) + Dyadic(high)) * q).sign();
  };
  const auto odd = [](double v) { return (std::bit_cast<std::uint64_t>(v) & 1U) != 0; };
  for (;;) {
    const double up = std::nextafter(x, INFINITY);
    const int side = above_half_way(x, up);
    if (side < 0 || (side == 0 && !odd(x))) break;
    x = up;
  }
  for (;;) {
    const double down = std::nextafter(x, 0.0);
    const int side = above_half_way(down, x);
    if (side > 0 || (side == 0 && !odd(x))) break;
    x = down;
  }
  return x;
}

bool parse_rational(std::string_view text, std::size_t slash, double& value, bool& rounded) {
  std::string_view top = text.substr(0, slash);
  const bool negative = !top.empty() && top[0] == '-';
  if (negative) top.remove_prefix(1);
  const auto p = parse_digits(top), q = parse_digits(text.substr(slash + 1));
  if (!p || !q || q->sign() == 0) return false;
  value = quotient(*p, *q);
  rounded = Dyadic(value) * *q != *p;
  if (negative) value = -value;
  return true;
}

/// Receives the parts of the JSON text one after the other.
class PolynomialReader {
 public:
  PolynomialReader(const std::string& name, std::string_view json, bool with_parameters)
      : name_(name), json_(json), with_parameters_(with_parameters) {}

  Polynomials read() {
    const Characters begin{json_.data(), &read_}, end{json_.data() + json_.size(), &read_};
    nlohmann::json::sax_parse(begin, end, this);
    if (out_.items.empty()) fail("", "found an empty list, expected at least one object");
    return std::move(out_);
  }

  // The interface that nlohmann::json asks for.
  bool null() { return unexpected("null"); }
  bool boolean(bool value) { return unexpected(value ? "true" : "false"); }
  bool number_integer(std::int64_t value) { return number(static_cast<double>(value)); }
  bool number_unsigned(std::uint64_t value) { return number(static_cast<double>(value)); }
  bool number_float(double value, const std::string&) { return number(value); }
  bool string(std::string& text) {
    double value = 0;
    bool rounded = false;
    if (!takes_number()) return unexpected(fmt::format("'{}'", shown(text)));
    if (!parse_number(text, value, rounded))
      fail(element(), fmt::format("found '{}', expected {}", shown(text), number_forms));
    if (rounded) ++out_.rounded;
    return number(value);
  }
  bool binary(std::vector<std::uint8_t>&) { return unexpected("binary data"); }
  bool start_object(std::size_t) {
    if (state_ != State::top && state_ != State::list) return unexpected("an object");
    state_ = State::object;
    out_.items.emplace_back();
    have_b_ = have_s_ = false;
    return true;
  }
  bool key(std::string& key) {
    const bool b = key == "b", s = key == "s" && with_parameters_;
    if (!b && !s)
      fail(object(), fmt::format("unknown key \"{}\", expected \"b\"{}", shown(key),
                                 with_parameters_ ? " and \"s\"" : ""));
    bool& have = b ? have_b_ : have_s_;
    if (have) fail(object(), fmt::format("the key \"{}\" is given twice", key));
    have = true;
    key_ = key[0];
    return true;
  }
  bool end_object() {
    if (!have_b_) fail(object(), "the key \"b\" is missing");
    if (with_parameters_ && !have_s_) fail(object(), "the key \"s\" is missing");
    state_ = out_.list ? State::list : State::end;
    return true;
  }
  bool start_array(std::size_t) {
    if (state_ == State::top) {
      state_ = State::list;
      out_.list = true;
    } else if (state_ == State::object) {
      state_ = State::numbers;
    } else {
      return unexpected("an array");
    }
    return true;
  }
  bool end_array() {
    if (state_ == State::list) {
      state_ = State::end;
      return true;
    }
    state_ = State::object;
    const std::size_t n = numbers().size(), most = bernstein::max_interval_degree + 1;
    if (key_ == 'b' && (n == 0 || n > most))
      fail(place("b"), fmt::format("found {} coefficients, expected 1 to {}", n, most));
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception& error) {
    fail_not_json(name_, json_, read_, error.what());
  }

 private:
  enum class State : std::uint8_t { top, list, object, numbers, end };

  std::vector<double>& numbers() { return key_ == 'b' ? out_.items.back().b : out_.items.back().s; }
  bool takes_number() const {
    return state_ == State::numbers || (state_ == State::object && key_ == 's');
  }
  bool number(double value) {
    if (!takes_number()) return unexpected("a number");
    if (!std::isfinite(value))
      fail(element(), "found a number beyond the range of doubles, expected a finite one");
    numbers().push_back(value);
    return true;
  }

  std::string object() const {
    return out_.list ? fmt::format("object {}", out_.items.size() - 1) : std::string();
  }
  std::string place(const std::string& what) const {
    return out_.list ? fmt::format("{}, {}", object(), what) : what;
  }
  std::string element() {
    return place(state_ == State::numbers ? fmt::format("{}[{}]", key_, numbers().size())
                                          : std::string(1, key_));
  }
  bool unexpected(const std::string& found) {
    switch (state_) {
      case State::numbers:
        fail(element(), fmt::format("found {}, expected {}", found, number_forms));
      case State::object:
        fail(place(std::string(1, key_)), fmt::format("found {}, expected {}an array of numbers",
                                                      found, key_ == 's' ? "a number or " : ""));
      case State::list:
        fail("", fmt::format("found {} in the list, expected objects", found));
      default:
        fail("", fmt::format("found {}, expected an object or a list of objects", found));
    }
  }
  [[noreturn]] void fail(const std::string& where, const std::string& message) const {
    throw InputError(json_place(name_, json_, read_, where), message);
  }

  const std::string& name_;
  std::string_view json_;
  bool with_parameters_;
  std::size_t read_ = 0;
  State state_ = State::top;
  bool have_b_ = false, have_s_ = false;
  char key_ = 'b';
  Polynomials out_;
};

}  // namespace

bool parse_number(std::string_view text, double& value, bool& rounded) {
  rounded = false;
  if (const auto slash = text.find('/'); slash != std::string_view::npos)
    return parse_rational(text, slash, value, rounded);
  return files::parse_real(text, value) && std::isfinite(value);
}

Polynomials read_polynomials(const std::string& name, std::string_view json, bool with_parameters) {
  Polynomials read = PolynomialReader(name, json, with_parameters).read();
  read.name = name;
  return read;
}

std::vector<double> parse_number_list(const std::string& option, std::string_view text,
                                      std::size_t& rounded) {
  std::vector<double> values;
  for (std::size_t start = 0;;) {
    const std::size_t end = std::min(text.find(',', start), text.size());
    double value = 0;
    bool inexact = false;
    if (!parse_number(text.substr(start, end - start), value, inexact))
      throw UsageError(fmt::format("{}: expected numbers such as 1,-3/4,0x1.8p-1, found '{}'",
                                   option, shown(text)));
    values.push_back(value);
    if (inexact) ++rounded;
    if (end == text.size()) return values;
    start = end + 1;
  }
}

}  // namespace bezel::cli
