#include "bezel/mesh/bvh.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include "bezel/base/error.hpp"
#include "bezel/mesh/morton.hpp"

namespace bezel {
namespace {

constexpr int leaf_size = 4;
constexpr int bin_count = 16;

/// Half the perimeter: proportional to the chance that a random line meets the box.
double half_perimeter(const Box2& b) {
  return b.empty() ? 0.0 : (b.hi[0] - b.lo[0]) + (b.hi[1] - b.lo[1]);
}

/// A finite sort key even for boxes that reach infinity.
double key(double lo, double hi) {
  constexpr double most = std::numeric_limits<double>::max() / 4;
  return 0.5 * std::clamp(lo, -most, most) + 0.5 * std::clamp(hi, -most, most);
}

Vec2 centre_of(const Box2& b) {
  return {key(b.lo[0], b.hi[0]), key(b.lo[1], b.hi[1])};
}

struct Item {
  Box2 box;
  std::int32_t number;
};

/// For items in one place of the curve: reorders [begin, end) and returns where the second half
/// begins: begin < split < end.
std::size_t split(std::vector<Item>& items, std::size_t begin, std::size_t end, bool halve) {
  Box2 centres;
  for (std::size_t k = begin; k < end; ++k) centres.include(centre_of(items[k].box));
  const Vec2 extent = centres.hi - centres.lo;
  const int axis = extent[1] > extent[0] ? 1 : 0;
  const auto first = items.begin() + static_cast<std::ptrdiff_t>(begin);
  const auto last = items.begin() + static_cast<std::ptrdiff_t>(end);

  if (!halve && extent[axis] > 0) {
    const double origin = centres.lo[axis], scale = bin_count / extent[axis];
    const auto bin = [&](const Item& item) {
      return std::clamp(static_cast<int>((centre_of(item.box)[axis] - origin) * scale), 0,
                        bin_count - 1);
    };
    if (std::isfinite(scale)) {
      std::array<Box2, bin_count> box;
      std::array<std::size_t, bin_count> count{};
      for (auto it = first; it != last; ++it) {
        const auto b = static_cast<std::size_t>(bin(*it));
        box[b].include(it->box);
        ++count[b];
      }
      std::array<double, bin_count> right_cost{};
      Box2 grown;
      std::size_t n = 0;
      for (std::size_t b = bin_count - 1; b > 0; --b) {
        grown.include(box[b]);
        right_cost[b] = half_perimeter(grown) * static_cast<double>(n += count[b]);
      }
      grown = Box2();
      n = 0;
      double best = std::numeric_limits<double>::infinity();
      int best_bin = 0;  // the first bin of the right half
      for (std::size_t b = 1; b < bin_count; ++b) {
        grown.include(box[b - 1]);
        n += count[b - 1];
        const double cost = half_perimeter(grown) * static_cast<double>(n) + right_cost[b];
        if (n > 0 && n < end - begin && cost < best) {
          best = cost;
          best_bin = static_cast<int>(b);
        }
      }
      if (best_bin > 0) {
        const auto middle =
            std::partition(first, last, [&](const Item& item) { return bin(item) < best_bin; });
        return static_cast<std::size_t>(middle - items.begin());
      }
    }
  }
  const std::size_t middle = begin + (end - begin) / 2;
  std::nth_element(first, items.begin() + static_cast<std::ptrdiff_t>(middle), last,
                   [&](const Item& a, const Item& b) {
                     const double at_a = centre_of(a.box)[axis], at_b = centre_of(b.box)[axis];
                     return at_a < at_b || (at_a == at_b && a.number < b.number);
                   });
  return middle;
}

/// Where the curve leaves the first half of the smallest cell that holds its places [begin, end),
/// which are not all equal.
std::size_t leave_half(const std::vector<MortonPlace>& places, std::size_t begin, std::size_t end) {
  const std::uint64_t apart = places[begin].key ^ places[end - 1].key;
  const std::uint64_t highest = std::uint64_t{1} << (63 - std::countl_zero(apart));
  const auto first = places.begin() + static_cast<std::ptrdiff_t>(begin);
  const auto last = places.begin() + static_cast<std::ptrdiff_t>(end);
  return static_cast<std::size_t>(
      std::partition_point(first, last,
                           [&](const MortonPlace& p) { return (p.key & highest) == 0; }) -
      places.begin());
}

}  // namespace

Bvh::Bvh(std::span<const Box2> boxes) {
  if (boxes.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    throw InputError("found " + std::to_string(boxes.size()) +
                     " boxes, expected at most 2147483647");
  std::vector<Vec2> centres;
  std::vector<std::int32_t> numbers;
  centres.reserve(boxes.size());
  numbers.reserve(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Box2& b = boxes[i];
    if (!(b.lo[0] <= b.hi[0] && b.lo[1] <= b.hi[1])) continue;
    centres.push_back(centre_of(b));
    numbers.push_back(static_cast<std::int32_t>(i));
  }
  if (centres.empty()) return;
  const std::vector<MortonPlace> places = morton_places(centres);
  std::vector<Item> items(places.size());
  for (std::size_t k = 0; k < items.size(); ++k) {
    const std::int32_t number = numbers[static_cast<std::size_t>(places[k].number)];
    items[k] = {boxes[static_cast<std::size_t>(number)], number};
  }

  struct Work {
    std::size_t node, begin, end;
    int depth;
  };
  nodes_.reserve(items.size());
  nodes_.emplace_back();
  std::vector<Work> stack{{0, 0, items.size(), 0}};
  while (!stack.empty()) {
    const Work work = stack.back();
    stack.pop_back();
    Node& node = nodes_[work.node];
    if (work.end - work.begin <= leaf_size) {
      node.first = static_cast<std::int32_t>(work.begin);
      node.count = static_cast<std::int32_t>(work.end - work.begin);
      continue;
    }
    const bool halve = work.depth >= max_depth / 2;
    const bool apart = places[work.begin].key != places[work.end - 1].key;
    const std::size_t middle = apart && halve ? work.begin + (work.end - work.begin) / 2
                               : apart        ? leave_half(places, work.begin, work.end)
                                              : split(items, work.begin, work.end, halve);
    const std::size_t child = nodes_.size();
    node.first = static_cast<std::int32_t>(child);
    nodes_.resize(child + 2);
    stack.push_back({child + 1, middle, work.end, work.depth + 1});
    stack.push_back({child, work.begin, middle, work.depth + 1});
  }
  // Children come after their parents.
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    Node& node = nodes_[n];
    const auto first = static_cast<std::size_t>(node.first);
    for (std::size_t k = 0; k < static_cast<std::size_t>(node.count); ++k)
      node.box.include(items[first + k].box);
    if (node.count > 0) continue;
    node.box.include(nodes_[first].box);
    node.box.include(nodes_[first + 1].box);
  }
  items_.reserve(items.size());
  boxes_.reserve(items.size());
  for (const Item& item : items) {
    items_.push_back(item.number);
    boxes_.push_back(item.box);
  }
}

void Bvh::query(const Box2& box, std::vector<std::int32_t>& out) const {
  query(box, [&](std::int32_t i) { out.push_back(i); });
}

}  // namespace bezel
