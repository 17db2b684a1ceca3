#pragma once
// What was found while common points are isolated, each once: neighbouring boxes may both find a
// root on their common border.

#include <algorithm>
#include <array>
#include <cstddef>

#include "bezel/geometry/isolate.hpp"

namespace bezel::geometry_kernel {

/// A closed box in the parameters.
struct ParameterBox {
  double s_lo, s_hi, t_lo, t_hi;
};
template <class P, class Q>
bool inside(const P& p, const Q& q) {
  return p.s_lo >= q.s_lo && p.s_hi <= q.s_hi && p.t_lo >= q.t_lo && p.t_hi <= q.t_hi;
}
template <class P, class Q>
bool disjoint(const P& p, const Q& q) {
  return p.s_hi < q.s_lo || q.s_hi < p.s_lo || p.t_hi < q.t_lo || q.t_hi < p.t_lo;
}

class FoundPoints {
 public:
  explicit FoundPoints(Isolation& out) : out_(out) {}

  std::size_t open_count() const { return out_.open.size(); }
  void leave_open(const ParameterBox& box) {
    out_.open.push_back({box.s_lo, box.s_hi, box.t_lo, box.t_hi, 0, 0.5 * (box.s_lo + box.s_hi),
                         0.5 * (box.t_lo + box.t_hi)});
  }

  /// A root that is alone in `enclosure`, which is inside the box it was found in.
  /// @return false when it may be one found before, or another; nothing is added then
  bool add(const ParameterBox& enclosure, double s, double t, int sign) {
    if (!settle_with_straddlers(enclosure, nullptr, false)) return false;
    if (!known_) push_root(enclosure, s, t, sign);
    return true;
  }

  /// A root whose enclosure reaches over the border of `box`, where it was found, and is inside
  /// `alone`, where it is the only one.
  bool add_straddler(const ParameterBox& enclosure, const ParameterBox& alone,
                     const ParameterBox& box, double s, double t, int sign) {
    if (count_ == straddlers_.size()) {
      leave_open(box);
      return true;
    }
    for (const IsolatedRoot& root : out_.roots) {
      if (inside(root, alone)) return true;
      if (!disjoint(root, enclosure)) return false;
    }
    const bool open =
        !(enclosure.s_lo > 0 && enclosure.s_hi < 1 && enclosure.t_lo > 0 && enclosure.t_hi < 1);
    if (!settle_with_straddlers(enclosure, &alone, open)) return false;
    if (known_) return true;
    straddlers_[count_++] = {enclosure, alone, open, out_.open.size()};
    if (open)
      out_.open.push_back({std::max(0.0, std::min(box.s_lo, enclosure.s_lo)),
                           std::min(1.0, std::max(box.s_hi, enclosure.s_hi)),
                           std::max(0.0, std::min(box.t_lo, enclosure.t_lo)),
                           std::min(1.0, std::max(box.t_hi, enclosure.t_hi)), sign, s, t});
    else
      push_root(enclosure, s, t, sign);
    return true;
  }

 private:
  struct Straddler {
    ParameterBox enclosure, alone;
    bool open;          // it reaches over the border of [0, 1]^2
    std::size_t index;  // among the open boxes
  };

  /// Whether the root is one of these is put into known_; false when that is not clear. One that
  /// was open there and is decided now is taken off the list.
  bool settle_with_straddlers(const ParameterBox& enclosure, const ParameterBox* alone, bool open) {
    known_ = false;
    for (std::size_t i = 0; i < count_; ++i) {
      Straddler& before = straddlers_[i];
      if (inside(enclosure, before.alone) ||
          (alone != nullptr && inside(before.enclosure, *alone))) {
        known_ = !before.open || open;
        if (!known_) take_off(before);
        return true;
      }
      if (!disjoint(enclosure, before.enclosure)) return false;
    }
    return true;
  }
  /// The last open box takes its place.
  void take_off(Straddler& straddler) {
    for (std::size_t j = 0; j < count_; ++j)
      if (straddlers_[j].open && straddlers_[j].index + 1 == out_.open.size())
        straddlers_[j].index = straddler.index;
    out_.open[straddler.index] = out_.open.back();
    out_.open.pop_back();
    straddler.open = false;
  }
  void push_root(const ParameterBox& b, double s, double t, int sign) {
    out_.roots.push_back({s, t, b.s_lo, b.s_hi, b.t_lo, b.t_hi, sign});
  }

  Isolation& out_;
  std::size_t count_ = 0;
  bool known_ = false;
  std::array<Straddler, 24> straddlers_;
};

}  // namespace bezel::geometry_kernel
