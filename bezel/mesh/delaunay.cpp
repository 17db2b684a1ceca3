#include "bezel/mesh/delaunay.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "bezel/base/error.hpp"

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

namespace bezel {
namespace {

struct Frame {
  Vec2 centre;
  int exponent = 0;  // 2^exponent is about half the extent
};

Frame frame_of(std::span<const Vec2> points) {
  Box2 box;
  for (const Vec2& p : points) box.include(p);
  const Vec2 half = 0.5 * box.hi - 0.5 * box.lo;
  const double extent = std::max(half[0], half[1]);
  return {0.5 * box.lo + 0.5 * box.hi, extent > 0 ? std::ilogb(extent) : 0};
}

/// The points moved and scaled (by a power of two) into a box around the origin: the lifted
/// coordinate x^2 + y^2 then loses no digits to an offset and cannot overflow.
std::vector<coordT> normalised(std::span<const Vec2> points, const Frame& frame) {
  std::vector<coordT> out;
  out.reserve(2 * points.size());
  for (const Vec2& p : points)
    for (int axis = 0; axis < 2; ++axis)
      out.push_back(std::scalbn(p[axis] - frame.centre[axis], -frame.exponent));
  return out;
}

bool on_one_line(const std::vector<coordT>& xy) {
  const std::size_t n = xy.size() / 2;
  const auto point = [&](std::size_t i) { return Vec2{{xy[2 * i], xy[2 * i + 1]}}; };
  std::size_t far = 0;
  for (std::size_t i = 0; i < n; ++i)
    if (norm(point(i) - point(0)) > norm(point(far) - point(0))) far = i;
  const Vec2 direction = point(far) - point(0);
  for (std::size_t i = 0; i < n; ++i)
    if (std::abs(cross(direction, point(i) - point(0))) > 1e-14 * dot(direction, direction))
      return false;
  return true;
}

/// Qhull's state and its messages, released on every path.
class Qhull {
 public:
  Qhull() : state_(std::make_unique<qhT>()), messages_(open_memstream(&text_, &text_size_)) {
    if (messages_ == nullptr) throw NumericsError("delaunay: no memory for the messages of qhull");
    qh_zero(state_.get(), messages_);
  }
  Qhull(const Qhull&) = delete;
  Qhull& operator=(const Qhull&) = delete;
  ~Qhull() {
    int long_count = 0, long_total = 0;
    qh_freeqhull(state_.get(), !qh_ALL);
    qh_memfreeshort(state_.get(), &long_count, &long_total);
    std::fclose(messages_);
    std::free(text_);
  }

  qhT* run(std::vector<coordT>& xy) {
    // Qt: only triangles. Qbb, Qz: robust for cocircular points and integers. Q12: no error for
    // wide facets.
    std::string command = "qhull d Qt Qbb Qc Qz Q12";
    const int status = qh_new_qhull(state_.get(), 2, static_cast<int>(xy.size() / 2), xy.data(),
                                    False, command.data(), nullptr, messages_);
    if (status != 0) {
      std::fflush(messages_);
      const std::string text(text_, text_size_);
      throw NumericsError("delaunay: " + text.substr(0, text.find('\n')));
    }
    return state_.get();
  }

 private:
  char* text_ = nullptr;
  std::size_t text_size_ = 0;
  std::unique_ptr<qhT> state_;
  FILE* messages_;
};

}  // namespace

std::vector<std::array<int, 3>> delaunay(std::span<const Vec2> points) {
  if (points.size() < 3)
    throw InputError("found " + std::to_string(points.size()) + " points, expected at least 3");
  if (points.size() > static_cast<std::size_t>(std::numeric_limits<int>::max() / 4))
    throw InputError("found " + std::to_string(points.size()) + " points, expected at most " +
                     std::to_string(std::numeric_limits<int>::max() / 4));
  for (std::size_t i = 0; i < points.size(); ++i)
    for (int axis = 0; axis < 2; ++axis)
      if (!std::isfinite(points[i][axis]))
        throw InputError(InputPlace{{}, 0, "point", static_cast<std::int64_t>(i)},
                         "found " + std::string(1, "xy"[axis]) + " = " +
                             std::to_string(points[i][axis]) + ", expected a finite value");
  const Frame frame = frame_of(points);
  std::vector<coordT> xy = normalised(points, frame);
  if (on_one_line(xy))
    throw InputError("found points on one line, expected points that span an area");

  Qhull qhull;
  qhT* const qh = qhull.run(xy);
  std::vector<std::array<int, 3>> triangles;
  triangles.reserve(2 * points.size());
  for (facetT* facet = qh->facet_list; facet != nullptr && facet->next != nullptr;
       facet = facet->next) {
    if (facet->upperdelaunay) continue;
    std::array<int, 3> corner{};
    std::size_t n = 0;
    for (const setelemT* e = facet->vertices->e; e->p != nullptr && n < 3; ++e)
      corner[n++] = qh_pointid(qh, static_cast<vertexT*>(e->p)->point);
    const auto side = [&](std::size_t i) {
      const Vec2 d =
          points[static_cast<std::size_t>(corner[i])] - points[static_cast<std::size_t>(corner[0])];
      return Vec2{{std::scalbn(d[0], -frame.exponent), std::scalbn(d[1], -frame.exponent)}};
    };
    const double area = cross(side(1), side(2));
    if (area < 0) std::swap(corner[1], corner[2]);
    if (area != 0) triangles.push_back(corner);
  }
  return triangles;
}

}  // namespace bezel
