#include "bezel/transfer/redistribute.hpp"

#include <algorithm>
#include <cmath>

namespace bezel::detail {
namespace {

/// A neighbourhood grows to this many values before its excess goes to all.
constexpr std::size_t largest_neighbourhood = 256;
/// Excesses below this fraction of the largest value are rounding, in the values or in the sums
/// they come from.
constexpr double excess_rounding = 1e-13;

/// A sum changes by this fraction of the sum of sizes when it is rounded.
constexpr double negligible = 0x1p-51;

/// Values around one value, in the order of their distance in the graph.
class Neighbourhood {
 public:
  Neighbourhood(std::size_t values, const Neighbours& neighbours)
      : neighbours_(neighbours), stamp_(values, 0) {}
  void start(std::int32_t i) {
    ++now_;
    stamp_[static_cast<std::size_t>(i)] = now_;
    members_.assign(1, i);
    ring_ = 0;
  }
  /// Adds the next ring; false when there is none, or the neighbourhood is as large as it may be.
  bool grow() {
    if (members_.size() >= largest_neighbourhood) return false;
    const std::size_t end = members_.size();
    for (; ring_ < end; ++ring_) {
      found_.clear();
      neighbours_(members_[ring_], found_);
      for (const std::int32_t n : found_) {
        std::uint32_t& seen = stamp_[static_cast<std::size_t>(n)];
        if (seen == now_) continue;
        seen = now_;
        members_.push_back(n);
      }
    }
    return members_.size() > end;
  }
  std::span<const std::int32_t> members() const { return members_; }

 private:
  const Neighbours& neighbours_;
  std::vector<std::uint32_t> stamp_;
  std::uint32_t now_ = 0;
  std::vector<std::int32_t> members_, found_;
  std::size_t ring_ = 0;  // the first member whose neighbours are not in yet
};

/// The values seen so that what is to be placed is positive: sign +1 for an excess above the upper
/// bounds, -1 for one below the lower bounds.
struct Side {
  std::span<double> value;
  std::span<const double> weight;
  const ValueBounds& bounds;
  double sign;
  double limit(std::size_t i) const { return sign > 0.0 ? bounds.most(i) : bounds.least(i); }
  /// Up to the bound, weighted; negative: by how much the value is beyond it.
  double room(std::size_t i) const { return sign * (limit(i) - value[i]) * weight[i]; }
  /// Moves the value a fraction of the way to its bound.
  void fill(std::size_t i, double fraction) const {
    if (room(i) <= 0.0) return;
    const double end = limit(i);
    const double filled = value[i] + fraction * (end - value[i]);
    value[i] = fraction >= 1.0 || sign * (filled - end) > 0.0 ? end : filled;
  }
};

}  // namespace

Redistribution redistribute(std::span<double> value, std::span<const double> weight,
                            const ValueBounds& bounds, const Neighbours& neighbours) {
  Redistribution done;
  double scale = 0.0;
  for (const double v : value) scale = std::max(scale, std::abs(v));
  Neighbourhood around(value.size(), neighbours);
  double rest = 0.0;  // to be placed anywhere; negative: to be taken from anywhere
  for (const double sign : {1.0, -1.0}) {
    const Side side{value, weight, bounds, sign};
    for (std::size_t i = 0; i < value.size(); ++i) {
      const double excess = -side.room(i);
      if (!(excess > 0.0)) continue;
      done.moved += excess;
      value[i] = side.limit(i);
      bool placed = false;
      if (excess > excess_rounding * scale * weight[i]) {
        around.start(static_cast<std::int32_t>(i));
        while (!placed && around.grow()) {
          double room = 0.0;
          for (const std::int32_t n : around.members())
            room += std::max(0.0, side.room(static_cast<std::size_t>(n)));
          if (room < excess) continue;
          placed = true;
          for (const std::int32_t n : around.members())
            side.fill(static_cast<std::size_t>(n), excess / room);
        }
      }
      if (!placed) rest += sign * excess;
    }
  }
  double size = 0.0;
  for (std::size_t i = 0; i < value.size(); ++i) size += std::abs(value[i]) * weight[i];
  // Values that are zero, or at a bound, stay so when there is no more than rounding to place.
  if (std::abs(rest) <= negligible * size) return done;
  const Side side{value, weight, bounds, rest > 0.0 ? 1.0 : -1.0};
  double room = 0.0;
  for (std::size_t i = 0; i < value.size(); ++i) room += std::max(0.0, side.room(i));
  const double amount = std::abs(rest);
  for (std::size_t i = 0; i < value.size(); ++i) side.fill(i, room > amount ? amount / room : 1.0);
  if (room < amount) done.left_over = side.sign * (amount - room);
  return done;
}

}  // namespace bezel::detail
