#pragma once
// Expressions as data: parsed once, evaluated for one point or many, with first and second derivatives.

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bezel {

/// An arithmetic expression such as "exp(x^2) + 2*y" in named variables.
class Formula {
 public:
  /// @param text       + - * / ^, unary minus, parentheses, numbers, pi, e, the variables, functions sin cos tan asin
  ///                   acos atan atan2 sinh cosh tanh exp log log10 log2 sqrt cbrt abs sign floor ceil min max pow
  ///                   hypot step(x) (0 below 0, else 1), if(condition, a, b), comparisons < <= > >= == != and && ||
  /// @param variables  names, in the order of the values
  /// @throws InputError naming the 1-based column and what was expected
  explicit Formula(std::string_view text, std::vector<std::string> variables = {"x", "y"});
  Formula(const Formula&);
  Formula(Formula&&) noexcept;
  Formula& operator=(const Formula&);
  Formula& operator=(Formula&&) noexcept;
  ~Formula();

  const std::string& text() const;
  const std::vector<std::string>& variables() const;
  /// One point; size of values = number of variables.
  double operator()(std::span<const double> values) const;
  double operator()(double x, double y) const;
  /// Many points: columns[v][q] is variable v at point q.
  void evaluate(std::span<const std::span<const double>> columns, std::span<double> out) const;
  /// Value and first derivatives with respect to every variable.
  double gradient(std::span<const double> values, std::span<double> first) const;
  /// Value, first derivatives, and second derivatives (row major, symmetric).
  double hessian(std::span<const double> values, std::span<double> first, std::span<double> second) const;

 private:
  struct Program;
  std::shared_ptr<const Program> program_;
};

}  // namespace bezel
