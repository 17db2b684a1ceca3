#pragma once
// Internal to the formula module: every operation, once, for double and for dual numbers.

#include <cmath>
#include <limits>
#include <numbers>

#include "bezel/formula/code.hpp"

namespace bezel::formula {

/// A value and its derivative in one direction. Dual<Dual<double>> carries two directions and the
/// mixed second derivative, so the rules below are written once for both orders.
template <class T>
struct Dual {
  T v{};  ///< value
  T d{};  ///< derivative
  Dual() = default;
  Dual(double value) : v(value), d(0.0) {}  // NOLINT: constants enter expressions
  Dual(T value, T derivative) : v(value), d(derivative) {}
};

inline double plain(double x) {
  return x;
}
template <class T>
double plain(const Dual<T>& x) {
  return plain(x.v);
}
inline bool is_zero(double x) {
  return x == 0.0;
}
template <class T>
bool is_zero(const Dual<T>& x) {
  return is_zero(x.v) && is_zero(x.d);
}
// f'(x) x': no NaN where f' is infinite but x does not depend on the direction.
template <class T>
T chain(const T& slope, const T& d) {
  return is_zero(d) ? T(0.0) : slope * d;
}

template <class T>
Dual<T> operator-(const Dual<T>& a) {
  return {-a.v, -a.d};
}
template <class T>
Dual<T> operator+(const Dual<T>& a, const Dual<T>& b) {
  return {a.v + b.v, a.d + b.d};
}
template <class T>
Dual<T> operator-(const Dual<T>& a, const Dual<T>& b) {
  return {a.v - b.v, a.d - b.d};
}
template <class T>
Dual<T> operator*(const Dual<T>& a, const Dual<T>& b) {
  return {a.v * b.v, a.d * b.v + a.v * b.d};
}
template <class T>
Dual<T> operator/(const Dual<T>& a, const Dual<T>& b) {
  const T q = a.v / b.v;
  return {q, (a.d - q * b.d) / b.v};
}

using std::acos;
using std::asin;
using std::atan;
using std::cbrt;
using std::cos;
using std::cosh;
using std::exp;
using std::log;
using std::log10;
using std::log2;
using std::sin;
using std::sinh;
using std::sqrt;
using std::tan;
using std::tanh;

inline double absolute(double x) {
  return std::fabs(x);
}
inline double sign_of(double x) {
  return x > 0 ? 1.0 : x < 0 ? -1.0 : x == 0 ? 0.0 : x;
}
inline double step_of(double x) {
  return x < 0 ? 0.0 : x >= 0 ? 1.0 : x;
}
inline double atan2_of(double y, double x) {
  return std::atan2(y, x);
}
inline double hypot_of(double a, double b) {
  return std::hypot(a, b);
}
inline double power_of(double a, double b) {
  return std::pow(a, b);
}

template <class T>
Dual<T> sin(const Dual<T>& x) {
  return {sin(x.v), chain(cos(x.v), x.d)};
}
template <class T>
Dual<T> cos(const Dual<T>& x) {
  return {cos(x.v), chain(-sin(x.v), x.d)};
}
template <class T>
Dual<T> tan(const Dual<T>& x) {
  const T t = tan(x.v);
  return {t, chain(T(1.0) + t * t, x.d)};
}
template <class T>
Dual<T> asin(const Dual<T>& x) {
  return {asin(x.v), chain(T(1.0) / sqrt((T(1.0) - x.v) * (T(1.0) + x.v)), x.d)};
}
template <class T>
Dual<T> acos(const Dual<T>& x) {
  return {acos(x.v), chain(T(-1.0) / sqrt((T(1.0) - x.v) * (T(1.0) + x.v)), x.d)};
}
template <class T>
Dual<T> atan(const Dual<T>& x) {
  return {atan(x.v), chain(T(1.0) / (T(1.0) + x.v * x.v), x.d)};
}
template <class T>
Dual<T> sinh(const Dual<T>& x) {
  return {sinh(x.v), chain(cosh(x.v), x.d)};
}
template <class T>
Dual<T> cosh(const Dual<T>& x) {
  return {cosh(x.v), chain(sinh(x.v), x.d)};
}
template <class T>
Dual<T> tanh(const Dual<T>& x) {
  // 1 / cosh^2 keeps its digits where 1 - tanh^2 cancels.
  const T c = T(1.0) / cosh(x.v);
  return {tanh(x.v), chain(c * c, x.d)};
}
template <class T>
Dual<T> exp(const Dual<T>& x) {
  const T y = exp(x.v);
  return {y, chain(y, x.d)};
}
template <class T>
Dual<T> log(const Dual<T>& x) {
  return {log(x.v), chain(T(1.0) / x.v, x.d)};
}
template <class T>
Dual<T> log10(const Dual<T>& x) {
  return {log10(x.v), chain(T(1.0) / (T(std::numbers::ln10) * x.v), x.d)};
}
template <class T>
Dual<T> log2(const Dual<T>& x) {
  return {log2(x.v), chain(T(1.0) / (T(std::numbers::ln2) * x.v), x.d)};
}
template <class T>
Dual<T> sqrt(const Dual<T>& x) {
  const T y = sqrt(x.v);
  return {y, chain(T(0.5) / y, x.d)};
}
template <class T>
Dual<T> cbrt(const Dual<T>& x) {
  const T y = cbrt(x.v);
  return {y, chain(T(1.0) / (T(3.0) * y * y), x.d)};
}
template <class T>
Dual<T> absolute(const Dual<T>& x) {
  return {absolute(x.v), chain(T(sign_of(plain(x.v))), x.d)};
}
template <class T>
Dual<T> atan2_of(const Dual<T>& y, const Dual<T>& x) {
  const T r = x.v * x.v + y.v * y.v;
  return {atan2_of(y.v, x.v), chain(x.v / r, y.d) - chain(y.v / r, x.d)};
}
template <class T>
Dual<T> hypot_of(const Dual<T>& a, const Dual<T>& b) {
  const T h = hypot_of(a.v, b.v);
  return {h, chain(a.v / h, a.d) + chain(b.v / h, b.d)};
}
template <class T>
Dual<T> power_of(const Dual<T>& a, const Dual<T>& b) {
  const T y = power_of(a.v, b.v);
  T d(0.0);
  // a^0 is constant; 0 * a^-1 would be NaN at a = 0.
  if (!is_zero(a.d) && !is_zero(b.v)) d = b.v * power_of(a.v, b.v - T(1.0)) * a.d;
  // a^b log(a) tends to 0 with a for b > 0.
  if (!is_zero(b.d) && !(plain(a) == 0 && plain(b) > 0)) d = d + y * log(a.v) * b.d;
  return {y, d};
}

/// x^n by squaring; n = 0 gives 1, negative n the reciprocal of x^-n.
template <class S>
S power_integer(S x, int n) {
  if (n < 0) return S(1.0) / power_integer(x, -n);
  if (n == 0) return S(1.0);
  while (n % 2 == 0) {
    x = x * x;
    n /= 2;
  }
  S y = x;
  for (n /= 2; n > 0; n /= 2) {
    x = x * x;
    if (n % 2 == 1) y = y * x;
  }
  return y;
}

/// Calls use(f) with f(S) -> S, the function behind a unary operation, so that a loop can stand
/// inside the switch.
template <class S, class Use>
void visit_unary(const Instruction& i, Use&& use) {
  switch (i.op) {
    case Op::negate:
      return use([](const S& x) { return -x; });
    case Op::sin:
      return use([](const S& x) { return sin(x); });
    case Op::cos:
      return use([](const S& x) { return cos(x); });
    case Op::tan:
      return use([](const S& x) { return tan(x); });
    case Op::asin:
      return use([](const S& x) { return asin(x); });
    case Op::acos:
      return use([](const S& x) { return acos(x); });
    case Op::atan:
      return use([](const S& x) { return atan(x); });
    case Op::sinh:
      return use([](const S& x) { return sinh(x); });
    case Op::cosh:
      return use([](const S& x) { return cosh(x); });
    case Op::tanh:
      return use([](const S& x) { return tanh(x); });
    case Op::exp:
      return use([](const S& x) { return exp(x); });
    case Op::log:
      return use([](const S& x) { return log(x); });
    case Op::log10:
      return use([](const S& x) { return log10(x); });
    case Op::log2:
      return use([](const S& x) { return log2(x); });
    case Op::sqrt:
      return use([](const S& x) { return sqrt(x); });
    case Op::cbrt:
      return use([](const S& x) { return cbrt(x); });
    case Op::abs:
      return use([](const S& x) { return absolute(x); });
    case Op::sign:
      return use([](const S& x) { return S(sign_of(plain(x))); });
    case Op::floor:
      return use([](const S& x) { return S(std::floor(plain(x))); });
    case Op::ceil:
      return use([](const S& x) { return S(std::ceil(plain(x))); });
    case Op::step:
      return use([](const S& x) { return S(step_of(plain(x))); });
    case Op::power_integer:
      return use([n = i.index](const S& x) { return power_integer(x, n); });
    default:
      return;
  }
}

/// The same for binary operations, f(S, S) -> S.
template <class S, class Use>
void visit_binary(Op op, Use&& use) {
  const auto truth = [](bool b) { return S(b ? 1.0 : 0.0); };
  switch (op) {
    case Op::add:
      return use([](const S& a, const S& b) { return a + b; });
    case Op::subtract:
      return use([](const S& a, const S& b) { return a - b; });
    case Op::multiply:
      return use([](const S& a, const S& b) { return a * b; });
    case Op::divide:
      return use([](const S& a, const S& b) { return a / b; });
    case Op::power:
      return use([](const S& a, const S& b) { return power_of(a, b); });
    case Op::atan2:
      return use([](const S& a, const S& b) { return atan2_of(a, b); });
    case Op::hypot:
      return use([](const S& a, const S& b) { return hypot_of(a, b); });
    case Op::min:  // a NaN on either side stays
      return use([](const S& a, const S& b) {
        return plain(a) < plain(b) || std::isnan(plain(a)) ? a : b;
      });
    case Op::max:
      return use([](const S& a, const S& b) {
        return plain(a) > plain(b) || std::isnan(plain(a)) ? a : b;
      });
    case Op::less:
      return use([=](const S& a, const S& b) { return truth(plain(a) < plain(b)); });
    case Op::less_equal:
      return use([=](const S& a, const S& b) { return truth(plain(a) <= plain(b)); });
    case Op::greater:
      return use([=](const S& a, const S& b) { return truth(plain(a) > plain(b)); });
    case Op::greater_equal:
      return use([=](const S& a, const S& b) { return truth(plain(a) >= plain(b)); });
    case Op::equal:
      return use([=](const S& a, const S& b) { return truth(plain(a) == plain(b)); });
    case Op::not_equal:
      return use([=](const S& a, const S& b) { return truth(plain(a) != plain(b)); });
    case Op::logical_and:
      return use([=](const S& a, const S& b) { return truth(plain(a) != 0 && plain(b) != 0); });
    case Op::logical_or:
      return use([=](const S& a, const S& b) { return truth(plain(a) != 0 || plain(b) != 0); });
    default:
      return;
  }
}

/// Runs a program for one point; stack holds code.stack_size values.
template <class S>
S run(const std::vector<Instruction>& instructions, const S* variables, S* stack) {
  S* end = stack;  // one past the top
  for (const Instruction& i : instructions) {
    if (i.op == Op::constant) {
      *end++ = S(i.value);
    } else if (i.op == Op::variable) {
      *end++ = variables[i.index];
    } else if (is_unary(i.op)) {
      visit_unary<S>(i, [&](auto f) { end[-1] = f(end[-1]); });
    } else if (is_binary(i.op)) {
      --end;
      visit_binary<S>(i.op, [&](auto f) { end[-1] = f(end[-1], end[0]); });
    } else {
      end -= 2;
      end[-1] = plain(end[-1]) != 0 ? end[0] : end[1];
    }
  }
  return end[-1];
}

}  // namespace bezel::formula
