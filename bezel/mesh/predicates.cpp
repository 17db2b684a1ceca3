#include "bezel/mesh/predicates.hpp"

#include <cmath>
#include <utility>
#include <vector>

#include "bezel/numeric/eft.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel {
namespace {

using short_names::u;

/// An exact real number: the sum of doubles that do not overlap, ascending in magnitude, none zero
/// [shewchuk1997, sec. 2]. Its sign is that of the last one.
class Expansion {
 public:
  Expansion() = default;
  explicit Expansion(const WithError& x) {
    if (x.error != 0) terms_.push_back(x.error);
    if (x.value != 0) terms_.push_back(x.value);
  }

  int sign() const { return terms_.empty() ? 0 : terms_.back() > 0 ? 1 : -1; }

  Expansion negated() const {
    Expansion out = *this;
    for (double& term : out.terms_) term = -term;
    return out;
  }

  /// Merges by magnitude and carries upwards (fast-expansion-sum needs strongly nonoverlapping
  /// operands, which two_sum carries keep).
  friend Expansion operator+(const Expansion& a, const Expansion& b) {
    Expansion out;
    out.terms_.reserve(a.terms_.size() + b.terms_.size());
    double carry = 0;
    for (std::size_t i = 0, j = 0; i < a.terms_.size() || j < b.terms_.size();) {
      const bool from_a = j == b.terms_.size() ||
                          (i < a.terms_.size() && std::abs(a.terms_[i]) < std::abs(b.terms_[j]));
      const WithError sum = two_sum(carry, from_a ? a.terms_[i++] : b.terms_[j++]);
      carry = sum.value;
      if (sum.error != 0) out.terms_.push_back(sum.error);
    }
    if (carry != 0) out.terms_.push_back(carry);
    return out;
  }
  friend Expansion operator-(const Expansion& a, const Expansion& b) { return a + b.negated(); }

  friend Expansion operator*(const Expansion& a, const Expansion& b) {
    Expansion out;
    for (const double factor : b.terms_) out = out + a.scaled(factor);
    return out;
  }

 private:
  /// Scale-expansion with zero elimination [shewchuk1997, fig. 13].
  Expansion scaled(double factor) const {
    Expansion out;
    out.terms_.reserve(2 * terms_.size());
    double carry = 0;
    for (const double term : terms_) {
      const WithError product = two_prod(term, factor);
      const WithError low = two_sum(carry, product.error);
      const WithError high = fast_two_sum(product.value, low.value);
      if (low.error != 0) out.terms_.push_back(low.error);
      if (high.error != 0) out.terms_.push_back(high.error);
      carry = high.value;
    }
    if (carry != 0) out.terms_.push_back(carry);
    return out;
  }

  std::vector<double> terms_;
};

Expansion difference(double a, double b) {
  return Expansion(two_sum(a, -b));
}

struct ExactVec {
  Expansion x, y;
  ExactVec(const Vec2& a, const Vec2& b) : x(difference(a[0], b[0])), y(difference(a[1], b[1])) {}
};

Expansion cross(const ExactVec& a, const ExactVec& b) {
  return a.x * b.y - a.y * b.x;
}
Expansion squared(const ExactVec& a) {
  return a.x * a.x + a.y * a.y;
}

}  // namespace

int orientation(const Vec2& a, const Vec2& b, const Vec2& c) {
  const double left = (a[0] - c[0]) * (b[1] - c[1]), right = (a[1] - c[1]) * (b[0] - c[0]);
  const double det = left - right;
  const double bound = (3 + 16 * u) * u * (std::abs(left) + std::abs(right));
  if (det > bound) return 1;
  if (-det > bound) return -1;
  return cross(ExactVec(a, c), ExactVec(b, c)).sign();
}

int in_circle(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const Vec2 x = a - d, y = b - d, z = c - d;
  const double yz1 = y[0] * z[1], yz2 = z[0] * y[1], zx1 = z[0] * x[1], zx2 = x[0] * z[1];
  const double xy1 = x[0] * y[1], xy2 = y[0] * x[1];
  const double xx = dot(x, x), yy = dot(y, y), zz = dot(z, z);
  const double det = xx * (yz1 - yz2) + yy * (zx1 - zx2) + zz * (xy1 - xy2);
  const double permanent = (std::abs(yz1) + std::abs(yz2)) * xx +
                           (std::abs(zx1) + std::abs(zx2)) * yy +
                           (std::abs(xy1) + std::abs(xy2)) * zz;
  const double bound = (10 + 96 * u) * u * permanent;
  if (det > bound) return 1;
  if (-det > bound) return -1;
  const ExactVec ex(a, d), ey(b, d), ez(c, d);
  return (squared(ex) * cross(ey, ez) + squared(ey) * cross(ez, ex) + squared(ez) * cross(ex, ey))
      .sign();
}

}  // namespace bezel
