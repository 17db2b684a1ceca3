// Recursive descent over the grammar
//
//   or      = and { "||" and }
//   and     = compare { "&&" compare }
//   compare = sum [ ("<" | "<=" | ">" | ">=" | "==" | "!=") sum ]
//   sum     = product { ("+" | "-") product }
//   product = unary { ("*" | "/") unary }
//   unary   = ("-" | "+") unary | power
//   power   = primary [ "^" unary ]
//   primary = number | name | function "(" or { "," or } ")" | "(" or ")"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "bezel/base/error.hpp"
#include "bezel/formula/operations.hpp"

namespace bezel::formula {
namespace {

constexpr std::size_t longest_text = 65536;
constexpr int deepest_nesting = 200;
constexpr std::size_t most_variables = 64;

struct Function {
  std::string_view name;
  Op op;
  int arguments;  // negative: at least that many
};

constexpr std::array<Function, 26> functions{{
    {"sin", Op::sin, 1},     {"cos", Op::cos, 1},   {"tan", Op::tan, 1},
    {"asin", Op::asin, 1},   {"acos", Op::acos, 1}, {"atan", Op::atan, 1},
    {"atan2", Op::atan2, 2}, {"sinh", Op::sinh, 1}, {"cosh", Op::cosh, 1},
    {"tanh", Op::tanh, 1},   {"exp", Op::exp, 1},   {"log", Op::log, 1},
    {"log10", Op::log10, 1}, {"log2", Op::log2, 1}, {"sqrt", Op::sqrt, 1},
    {"cbrt", Op::cbrt, 1},   {"abs", Op::abs, 1},   {"sign", Op::sign, 1},
    {"floor", Op::floor, 1}, {"ceil", Op::ceil, 1}, {"min", Op::min, -2},
    {"max", Op::max, -2},    {"pow", Op::power, 2}, {"hypot", Op::hypot, 2},
    {"step", Op::step, 1},   {"if", Op::select, 3},
}};

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

bool is_name(std::string_view s) {
  return !s.empty() && is_letter(s[0]) &&
         std::all_of(s.begin(), s.end(), [](char c) { return is_letter(c) || is_digit(c); });
}

std::string quoted(std::string_view s) {
  return std::string("'").append(s).append("'");
}

class Parser {
 public:
  Parser(std::string_view text, const std::vector<std::string>& variables)
      : text_(text), variables_(variables) {}

  Code parse() {
    parse_or();
    if (at_ != text_.size()) fail(at_, "expected an operator or the end, found " + found());
    return std::move(code_);
  }

 private:
  // ---- text ----
  [[noreturn]] void fail(std::size_t at, const std::string& message) const {
    throw InputError(
        std::string("column ").append(std::to_string(at + 1)).append(": ").append(message));
  }
  void skip_space() {
    while (at_ < text_.size() &&
           (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n' || text_[at_] == '\r')) {
      ++at_;
    }
  }
  bool accept(std::string_view token) {
    skip_space();
    if (text_.substr(at_, token.size()) != token) return false;
    at_ += token.size();
    return true;
  }
  char peek() {
    skip_space();
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  std::string_view name_at(std::size_t at) const {
    std::size_t end = at;
    while (end < text_.size() && (is_letter(text_[end]) || is_digit(text_[end]))) ++end;
    return text_.substr(at, end - at);
  }
  // What stands at the current place, for messages.
  std::string found() {
    skip_space();
    if (at_ >= text_.size()) return "the end";
    const char c = text_[at_];
    if (is_letter(c)) return quoted(name_at(at_));
    if (c >= ' ' && c <= '~') return quoted(text_.substr(at_, 1));
    char text[16];
    std::snprintf(text, sizeof text, "byte 0x%02x",
                  static_cast<unsigned>(static_cast<unsigned char>(c)));
    return text;
  }
  void expect(char c, const std::string& why) {
    if (peek() != c || at_ >= text_.size()) {
      fail(at_, std::string("expected ")
                    .append(quoted(std::string_view(&c, 1)))
                    .append(why)
                    .append(", found ")
                    .append(found()));
    }
    ++at_;
  }

  // ---- code ----
  void push(Instruction i) {
    code_.instructions.push_back(i);
    code_.stack_size = std::max(code_.stack_size, ++depth_of_stack_);
  }
  // Appends an operation on `operands` values; folds it when they are all constants.
  void apply(Instruction i, int operands) {
    auto& list = code_.instructions;
    depth_of_stack_ -= operands - 1;
    const auto n = static_cast<std::ptrdiff_t>(operands);
    const bool constant = std::all_of(list.end() - n, list.end(),
                                      [](const Instruction& k) { return k.op == Op::constant; });
    if (!constant) {
      list.push_back(i);
      return;
    }
    std::vector<Instruction> part(list.end() - n, list.end());
    part.push_back(i);
    std::array<double, 3> stack{};
    list.erase(list.end() - n, list.end());
    list.push_back({Op::constant, 0, run<double>(part, nullptr, stack.data())});
  }
  void apply_power() {
    const Instruction exponent = code_.instructions.back();
    if (exponent.op == Op::constant && std::fabs(exponent.value) <= largest_integer_power &&
        exponent.value == std::floor(exponent.value)) {
      code_.instructions.pop_back();
      --depth_of_stack_;
      apply({Op::power_integer, static_cast<std::int32_t>(exponent.value), 0}, 1);
    } else {
      apply({Op::power, 0, 0}, 2);
    }
  }

  // ---- grammar ----
  struct Level {
    explicit Level(Parser& p) : parser(p) {
      if (++p.nesting_ > deepest_nesting) {
        p.fail(p.at_, "nested deeper than " + std::to_string(deepest_nesting) + " levels");
      }
    }
    Level(const Level&) = delete;
    Level& operator=(const Level&) = delete;
    ~Level() { --parser.nesting_; }
    Parser& parser;
  };

  void parse_or() {
    parse_and();
    while (accept("||")) {
      parse_and();
      apply({Op::logical_or, 0, 0}, 2);
    }
  }
  void parse_and() {
    parse_compare();
    while (accept("&&")) {
      parse_compare();
      apply({Op::logical_and, 0, 0}, 2);
    }
  }
  bool accept_comparison(Op& op) {
    // Two-character tokens first.
    constexpr std::array<std::pair<std::string_view, Op>, 6> tokens{{{"<=", Op::less_equal},
                                                                     {">=", Op::greater_equal},
                                                                     {"==", Op::equal},
                                                                     {"!=", Op::not_equal},
                                                                     {"<", Op::less},
                                                                     {">", Op::greater}}};
    for (const auto& token : tokens) {
      if (accept(token.first)) {
        op = token.second;
        return true;
      }
    }
    return false;
  }
  void parse_compare() {
    parse_sum();
    Op op{};
    if (!accept_comparison(op)) return;
    parse_sum();
    apply({op, 0, 0}, 2);
    skip_space();
    const std::size_t at = at_;
    if (accept_comparison(op)) fail(at, "comparisons cannot be chained, use && between them");
  }
  void parse_sum() {
    parse_product();
    for (;;) {
      const Op op = accept("+") ? Op::add : accept("-") ? Op::subtract : Op::constant;
      if (op == Op::constant) return;
      parse_product();
      apply({op, 0, 0}, 2);
    }
  }
  void parse_product() {
    parse_unary();
    for (;;) {
      const Op op = accept("*") ? Op::multiply : accept("/") ? Op::divide : Op::constant;
      if (op == Op::constant) return;
      parse_unary();
      apply({op, 0, 0}, 2);
    }
  }
  void parse_unary() {
    const Level level(*this);
    if (accept("-")) {
      parse_unary();
      apply({Op::negate, 0, 0}, 1);
    } else if (accept("+")) {
      parse_unary();
    } else {
      parse_power();
    }
  }
  void parse_power() {
    parse_primary();
    if (accept("^")) {
      parse_unary();
      apply_power();
    }
  }
  void parse_primary() {
    const char c = peek();
    if (is_digit(c) || c == '.') {
      parse_number();
    } else if (is_letter(c)) {
      parse_name();
    } else if (accept("(")) {
      parse_or();
      expect(')', "");
    } else {
      fail(at_, "expected a value, found " + found());
    }
  }
  void parse_number() {
    double value = 0;
    const char* first = text_.data() + at_;
    const auto result = std::from_chars(first, text_.data() + text_.size(), value);
    if (result.ec == std::errc::invalid_argument) fail(at_, "expected a number, found " + found());
    const auto length = static_cast<std::size_t>(result.ptr - first);
    if (result.ec == std::errc::result_out_of_range) {
      fail(at_, "number " + std::string(text_.substr(at_, std::min<std::size_t>(length, 40))) +
                    " is outside the range of a double");
    }
    at_ += length;
    push({Op::constant, 0, value});
  }
  void parse_name() {
    const std::size_t start = at_;
    const std::string_view name = name_at(at_);
    at_ += name.size();
    if (peek() == '(') return parse_call(start, name);
    const auto variable = std::find(variables_.begin(), variables_.end(), name);
    if (variable != variables_.end()) {
      push({Op::variable, static_cast<std::int32_t>(variable - variables_.begin()), 0});
    } else if (name == "pi") {
      push({Op::constant, 0, std::numbers::pi});
    } else if (name == "e") {
      push({Op::constant, 0, std::numbers::e});
    } else if (std::any_of(functions.begin(), functions.end(),
                           [&](const Function& f) { return f.name == name; })) {
      fail(at_, "expected '(' after " + std::string(name) + ", found " + found());
    } else {
      std::string expected = variables_.empty() ? "expected " : "expected one of ";
      for (const std::string& v : variables_) expected.append(v).append(", ");
      fail(start, "unknown name " + quoted(name) + ", " + expected + "a function or a number");
    }
  }
  void parse_call(std::size_t start, std::string_view name) {
    const auto* function = std::find_if(functions.begin(), functions.end(),
                                        [&](const Function& f) { return f.name == name; });
    if (function == functions.end()) {
      if (std::find(variables_.begin(), variables_.end(), name) != variables_.end() ||
          name == "pi" || name == "e") {
        fail(at_, quoted(name) + " is not a function; expected an operator, found '('");
      }
      std::string expected;
      for (const Function& f : functions)
        expected.append(expected.empty() ? "" : ", ").append(f.name);
      fail(start, "unknown function " + quoted(name) + ", expected one of " + expected);
    }
    expect('(', "");
    int count = 0;
    if (peek() != ')') {
      do {
        parse_or();
        ++count;
        // min(a, b, c) = min(min(a, b), c)
        if (function->arguments < 0 && count >= 2) apply({function->op, 0, 0}, 2);
      } while (accept(","));
    }
    expect(')', " or ','");
    const int least = std::abs(function->arguments);
    if (count < least || (function->arguments > 0 && count > least)) {
      fail(start, std::string(name) + " takes " + (function->arguments < 0 ? "at least " : "") +
                      std::to_string(least) + (least == 1 ? " argument" : " arguments") +
                      ", found " + std::to_string(count));
    }
    if (function->op == Op::power) return apply_power();
    if (function->arguments > 0) apply({function->op, 0, 0}, least);
  }

  std::string_view text_;
  const std::vector<std::string>& variables_;
  std::size_t at_ = 0;
  int nesting_ = 0;
  int depth_of_stack_ = 0;
  Code code_;
};

}  // namespace

Code compile(std::string_view text, const std::vector<std::string>& variables) {
  if (text.size() > longest_text) {
    throw InputError("formula of " + std::to_string(text.size()) + " characters, at most " +
                     std::to_string(longest_text) + " are allowed");
  }
  if (variables.size() > most_variables) {
    throw InputError("formula of " + std::to_string(variables.size()) + " variables, at most " +
                     std::to_string(most_variables) + " are allowed");
  }
  for (auto v = variables.begin(); v != variables.end(); ++v) {
    if (!is_name(*v))
      throw InputError("variable " + quoted(*v) + " is not a name of letters, digits and _");
    if (std::find(variables.begin(), v, *v) != v)
      throw InputError("variable " + quoted(*v) + " is named twice");
  }
  return Parser(text, variables).parse();
}

}  // namespace bezel::formula
