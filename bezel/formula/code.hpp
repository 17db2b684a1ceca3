#pragma once
// Internal to the formula module: the flat program a formula is compiled to.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace bezel::formula {

/// Operations of a stack machine. Each takes its operands from the top of the stack and leaves one
/// value.
enum class Op : std::uint8_t {
  constant,
  variable,  // no operand
  negate,
  sin,
  cos,
  tan,
  asin,
  acos,
  atan,
  sinh,
  cosh,
  tanh,  // one operand
  exp,
  log,
  log10,
  log2,
  sqrt,
  cbrt,
  abs,
  sign,
  floor,
  ceil,
  step,
  power_integer,  // one operand, exponent in `index`
  add,
  subtract,
  multiply,
  divide,
  power,
  atan2,
  hypot,
  min,
  max,  // two operands
  less,
  less_equal,
  greater,
  greater_equal,
  equal,
  not_equal,
  logical_and,
  logical_or,
  select  // three: condition, a, b
};

constexpr bool is_unary(Op op) {
  return op >= Op::negate && op <= Op::power_integer;
}
constexpr bool is_binary(Op op) {
  return op >= Op::add && op <= Op::logical_or;
}

struct Instruction {
  Op op;
  std::int32_t index = 0;  ///< variable's number, or integer exponent
  double value = 0;        ///< constant
};

struct Code {
  std::vector<Instruction> instructions;
  int stack_size = 0;  ///< most values on the stack at once
};

/// Largest exponent in size that is computed by repeated multiplication.
inline constexpr int largest_integer_power = 64;

/// Parses and compiles. @throws InputError with the column
Code compile(std::string_view text, const std::vector<std::string>& variables);

}  // namespace bezel::formula
