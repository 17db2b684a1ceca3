#pragma once
// A plane Bezier curve in exact arithmetic: Taylor coefficients, and common points of two curves at
// rational parameters. Internal.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bezel/numeric/dyadic.hpp"
#include "bezel/numeric/ratio.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel::geometry_kernel {

using ExactPoint = std::array<Dyadic, 2>;
/// Coefficients of 1, h, h^2, ...; at least one.
using Polynomial = std::vector<Dyadic>;
using ExactTaylor = std::array<Polynomial, 2>;  ///< by coordinate

Polynomial product(const Polynomial& a, const Polynomial& b);
/// f(g).
Polynomial compose(const Polynomial& f, const Polynomial& g);

class ExactCurve {
 public:
  /// The curve times 2^-exponent. @param control  1 to 61 finite points, unchecked
  ExactCurve(std::span<const Vec2> control, std::int64_t exponent);
  /// Of the polynomials, leading zeros left out; 0 for a point.
  int degree() const { return static_cast<int>(c_[0].size()) - 1; }
  ExactPoint operator()(const Dyadic& s) const;
  /// curve(at + h) as a polynomial in h.
  ExactTaylor taylor(const Dyadic& at) const;
  /// curve(at + h) times at.den^degree.
  ExactTaylor taylor(const Ratio& at) const;
  const ExactTaylor& monomial() const { return c_; }
  /// Of a curve on a straight line, along it; nothing for others and for points.
  const std::optional<ExactPoint>& direction() const { return direction_; }

 private:
  ExactTaylor c_;
  std::optional<ExactPoint> direction_;
};

/// A common point of two curves at rational parameters, verified.
struct ExactContact {
  Ratio s, t;
  /// Taylor coefficients at s and t, with a common factor.
  ExactTaylor a, b;
};
/// Nothing when a(s) and b(t) differ.
std::optional<ExactContact> verify_contact(const ExactCurve& a, const ExactCurve& b, const Ratio& s,
                                           const Ratio& t);
/// Whether a(s + h) = b(t + h p / q) identically, with p and q the coordinates of the two
/// derivatives on `axis`: the curves are one under an affine change of parameter.
struct AffineChange {
  Dyadic p, q;
};
std::optional<AffineChange> coincide(const ExactContact& contact);

/// Order of contact and a neighbourhood without another common point. b must be regular there, with
/// b'[axis] != 0.
struct ContactOrder {
  int order;        ///< of a - b in h when b is taken opposite a; 0: not found within the limit
  double s_radius;  ///< no other common point with |s - contact.s| <= s_radius and b's parameter in
                    ///< a range where b[axis] is monotone; 0 when none was found
  int sign;  ///< odd orders: as of cross(a', b') where that is not 0, else 0: 1 when b passes
             ///< from right to left of a, or a from left to right of b
};
/// @param limit  orders above are not looked for
/// @param start  s_radius is at most this
ContactOrder contact_order(const ExactContact& contact, int axis, int limit, double start);

/// Whether both polynomials f and g vanish at one place of [lo, hi], decided by their greatest
/// common divisor; nothing when undecided (degree above 12).
std::optional<bool> common_root(Polynomial f, Polynomial g, const Dyadic& lo, const Dyadic& hi);

}  // namespace bezel::geometry_kernel
