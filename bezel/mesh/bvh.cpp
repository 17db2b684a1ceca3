#include "bezel/mesh/bvh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "bezel/base/error.hpp"

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

struct Item {
  Box2 box;
  Vec2 centre;
  std::int32_t number;
};

/// Reorders [begin, end) and returns where the second half begins: begin < split < end.
std::size_t split(std::vector<Item>& items, std::size_t begin, std::size_t end, bool halve) {
  Box2 centres;
  for (std::size_t k = begin; k < end; ++k) centres.include(items[k].centre);
  const Vec2 extent = centres.hi - centres.lo;
  const int axis = extent[1] > extent[0] ? 1 : 0;
  const auto first = items.begin() + static_cast<std::ptrdiff_t>(begin);
  const auto last = items.begin() + static_cast<std::ptrdiff_t>(end);

  if (!halve && extent[axis] > 0) {
    const double origin = centres.lo[axis], scale = bin_count / extent[axis];
    const auto bin = [&](const Item& item) {
      return std::clamp(static_cast<int>((item.centre[axis] - origin) * scale), 0, bin_count - 1);
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
                     return a.centre[axis] < b.centre[axis] ||
                            (a.centre[axis] == b.centre[axis] && a.number < b.number);
                   });
  return middle;
}

}  // namespace

Bvh::Bvh(std::span<const Box2> boxes) {
  if (boxes.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    throw InputError("found " + std::to_string(boxes.size()) +
                     " boxes, expected at most 2147483647");
  std::vector<Item> items;
  items.reserve(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Box2& b = boxes[i];
    if (b.lo[0] <= b.hi[0] && b.lo[1] <= b.hi[1])
      items.push_back(
          {b, {key(b.lo[0], b.hi[0]), key(b.lo[1], b.hi[1])}, static_cast<std::int32_t>(i)});
  }
  if (items.empty()) return;

  struct Work {
    std::size_t node, begin, end;
    int depth;
  };
  nodes_.reserve(items.size() / 2 + 1);
  nodes_.emplace_back();
  std::vector<Work> stack{{0, 0, items.size(), 0}};
  while (!stack.empty()) {
    const Work work = stack.back();
    stack.pop_back();
    Node node;
    for (std::size_t k = work.begin; k < work.end; ++k) node.box.include(items[k].box);
    if (work.end - work.begin <= leaf_size) {
      node.first = static_cast<std::int32_t>(work.begin);
      node.count = static_cast<std::int32_t>(work.end - work.begin);
    } else {
      const std::size_t middle = split(items, work.begin, work.end, work.depth >= max_depth / 2);
      const std::size_t child = nodes_.size();
      node.first = static_cast<std::int32_t>(child);
      nodes_.resize(child + 2);
      stack.push_back({child + 1, middle, work.end, work.depth + 1});
      stack.push_back({child, work.begin, middle, work.depth + 1});
    }
    nodes_[work.node] = node;
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
