// Values of a field at points of the plane.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "bezel/base/error.hpp"
#include "bezel/field/element_kernel.hpp"
#include "bezel/field/field.hpp"
#include "bezel/mesh/bvh.hpp"
#include "bezel/numeric/box.hpp"

namespace bezel {
namespace {

constexpr double tolerance = 1e-12;  // how far below zero a barycentric may be
constexpr std::size_t chunk = 128;   // points per task

Box2 padded(const Box2& box) {
  // Points within `tolerance` of an edge count as inside: at most that part of the control points'
  // extent away, with room for the growth of the map just outside the triangle.
  return grown(box, 16.0 * tolerance * box.diameter());
}

}  // namespace

struct FieldEvaluator::Impl {
  explicit Impl(Field f) : field(std::move(f)) {
    std::vector<Box2> boxes(field.mesh().element_count());
    for (std::size_t e = 0; e < boxes.size(); ++e)
      boxes[e] = padded(field.mesh().box(ElementId(e)));
    tree = Bvh(boxes);
  }

  Place locate(const Vec2& p, std::vector<std::int32_t>& candidates) const {
    Place place{ElementId{}, {0.0, 0.0, 0.0}};
    if (!std::isfinite(p.x()) || !std::isfinite(p.y())) return place;
    Box2 box;
    box.include(p);
    candidates.clear();
    tree.query(box, candidates);
    std::sort(candidates.begin(), candidates.end());
    for (const std::int32_t i : candidates) {
      const ElementId e(i);
      const field_detail::ElementMap map(field.mesh(), e);
      const LocateResult found = bezel::locate(map.degree(), map.control(), p, tolerance);
      if (found.status != Location::inside) continue;
      place.element = e;
      place.lambda = found.lambda;
      break;
    }
    return place;
  }

  /// Puts n values per point to `out`, by `at(element, lambda, values)`; NAN outside the mesh.
  template <class At>
  void fill(std::span<const Vec2> points, std::size_t n, std::span<double> out, int threads,
            const At& at) const {
    if (out.size() != points.size() * n)
      throw InputError(
          fmt::format("found room for {} values, expected {}", out.size(), points.size() * n));
    parallel_for(
        (points.size() + chunk - 1) / chunk,
        [&](std::size_t task) {
          std::vector<std::int32_t> candidates;
          for (std::size_t q = task * chunk; q < std::min(points.size(), (task + 1) * chunk); ++q) {
            const std::span<double> values = out.subspan(q * n, n);
            const Place place = locate(points[q], candidates);
            if (place.element.valid())
              at(place.element, place.lambda, values);
            else
              std::fill(values.begin(), values.end(), std::numeric_limits<double>::quiet_NaN());
          }
        },
        threads);
  }

  Field field;
  Bvh tree;
};

FieldEvaluator::FieldEvaluator(Field field) : impl_(std::make_unique<Impl>(std::move(field))) {}
FieldEvaluator::FieldEvaluator(FieldEvaluator&&) noexcept = default;
FieldEvaluator& FieldEvaluator::operator=(FieldEvaluator&&) noexcept = default;
FieldEvaluator::~FieldEvaluator() = default;

const Field& FieldEvaluator::field() const {
  return impl_->field;
}

FieldEvaluator::Place FieldEvaluator::locate(const Vec2& p) const {
  std::vector<std::int32_t> candidates;
  return impl_->locate(p, candidates);
}

void FieldEvaluator::evaluate(std::span<const Vec2> points, std::span<double> out,
                              int threads) const {
  const Field& field = impl_->field;
  impl_->fill(points, static_cast<std::size_t>(field.components()), out, threads,
              [&](ElementId e, const auto& lambda, std::span<double> values) {
                field.evaluate(e, lambda, values);
              });
}

void FieldEvaluator::gradient(std::span<const Vec2> points, std::span<double> out,
                              int threads) const {
  const Field& field = impl_->field;
  impl_->fill(points, 2 * static_cast<std::size_t>(field.components()), out, threads,
              [&](ElementId e, const auto& lambda, std::span<double> values) {
                field.gradient(e, lambda, values);
              });
}

}  // namespace bezel
