#pragma once
// Expressions as data: parsed once, evaluated for one point or many, with first and second
// derivatives.

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bezel {

/// An arithmetic expression such as "exp(x^2) + 2*y" in named variables. Immutable; cheap to copy;
/// safe to use from several threads at once.
///
/// From loosest to tightest: ||, &&, comparisons (not chained), + and -, * and /, unary - and +, ^
/// (to the right: 2^3^2 = 2^9, and -x^2 = -(x^2)). Comparisons and logic give 1 or 0; any value but
/// 0 counts as true. A constant integer exponent up to 64 in size is computed by repeated
/// multiplication (n - 1 roundings at most), any other by pow. Outside its domain a function gives
/// what the C library gives (NaN or infinity), not an exception.
///
/// @accuracy each operation is rounded once, each function is the C library's; one point and a
/// batch give the
///           same bits
/// @limits   65536 characters, 200 nested levels, 64 variables
class Formula {
 public:
  /// @param text       + - * / ^, unary minus, parentheses, numbers, pi, e, the variables,
  /// functions sin cos tan
  ///                   asin acos atan atan2(y, x) sinh cosh tanh exp log log10 log2 sqrt cbrt abs
  ///                   sign floor ceil min max (two or more arguments) pow hypot step(x) (0 below
  ///                   0, else 1), if(condition, a, b), comparisons < <= > >= == != and && ||
  /// @param variables  names (letters, digits, _), in the order of the values; they hide pi and e
  /// @throws InputError "column 7: unknown name 'z', expected one of x, y, a function or a number":
  /// the 1-based
  ///         column and what was expected
  explicit Formula(std::string_view text, std::vector<std::string> variables = {"x", "y"});
  Formula(const Formula&);
  Formula(Formula&&) noexcept;
  Formula& operator=(const Formula&);
  Formula& operator=(Formula&&) noexcept;
  ~Formula();

  const std::string& text() const;
  const std::vector<std::string>& variables() const;

  /// Value at one point.
  ///
  /// @param values  one per variable
  /// @throws InputError when the number of values differs
  double operator()(std::span<const double> values) const;
  /// Value at (x, y), for a formula of two variables.
  double operator()(double x, double y) const;

  /// Values at many points, the same bits as one by one; blocks of points keep the arithmetic
  /// vectorised.
  ///
  /// @param columns  columns[v][q] is variable v at point q
  /// @param out      one per point; may be one of the columns
  /// @throws InputError when the sizes differ
  void evaluate(std::span<const std::span<const double>> columns, std::span<double> out) const;

  /// Value and first derivatives with respect to every variable, by forward differentiation (exact
  /// up to rounding). At a kink (abs, min, max, if) it is the derivative of one side, 0 for abs;
  /// floor, ceil, sign, step and comparisons count as constant.
  ///
  /// @param first  one per variable
  /// @throws InputError when the sizes differ
  double gradient(std::span<const double> values, std::span<double> first) const;

  /// Value, first and second derivatives.
  ///
  /// @param second  row major, size n*n for n variables, symmetric bit for bit
  /// @throws InputError when the sizes differ
  double hessian(std::span<const double> values, std::span<double> first,
                 std::span<double> second) const;

 private:
  struct Program;
  std::shared_ptr<const Program> program_;
};

}  // namespace bezel
