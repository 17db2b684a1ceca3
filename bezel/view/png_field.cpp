#include "bezel/view/png_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "bezel/base/parallel.hpp"
#include "bezel/bernstein/triangle.hpp"
#include "bezel/geometry/triangle.hpp"
#include "bezel/view/raster.hpp"
#include "bezel/view/scalar.hpp"

namespace bezel::view {
namespace {

constexpr double outline_tolerance = 0.02;  // pixels
constexpr double least_cover = 1e-6;        // of a pixel: less is rounding
constexpr int lattice = 8;                  // start values per side

struct Sample {
  std::size_t pixel;
  double cover;
  Colour colour;
};

/// Reference points of the pixels of one element.
class Inverter {
 public:
  Inverter(int degree, std::span<const Vec2> control, double pixel)
      : degree_(degree), control_(control) {
    for (int k = 0; k <= lattice; ++k)
      for (int j = 0; j <= lattice - k; ++j) {
        start_.push_back({static_cast<double>(lattice - j - k) / lattice,
                          static_cast<double>(j) / lattice, static_cast<double>(k) / lattice});
        place_.push_back(bernstein::evaluate<Vec2>(degree, control, start_.back()));
      }
    Box2 box;
    for (const Vec2& p : control) box.include(p);
    tiny_ = box.diameter() < pixel;
  }

  /// @param inside  whether the pixel's centre is known to lie in the element
  /// @param warm    the reference point of a neighbouring pixel, or null
  Lambda operator()(const Vec2& p, bool inside, const Lambda* warm) const {
    if (tiny_) return start_[nearest(p, -1.0)];
    if (warm != nullptr) {
      const InverseResult result = invert(degree_, control_, p, *warm);
      if (good(result, inside)) return result.lambda;
    }
    // From the nearest places of the lattice, by growing distance.
    double beyond = -1.0;
    std::size_t first = 0;
    for (int attempt = 0; attempt < 3; ++attempt) {
      const std::size_t n = nearest(p, beyond);
      if (attempt == 0) first = n;
      const InverseResult result = invert(degree_, control_, p, start_[n]);
      if (good(result, inside)) return result.lambda;
      const Vec2 d = place_[n] - p;
      beyond = dot(d, d);
    }
    if (inside) {
      const LocateResult result = locate(degree_, control_, p, 1e-6);
      if (result.status == Location::inside) return result.lambda;
    }
    return start_[first];
  }

 private:
  bool good(const InverseResult& result, bool inside) const {
    if (!result.converged) return false;
    const double least = std::min({result.lambda[0], result.lambda[1], result.lambda[2]});
    return least >= (inside ? -1e-6 : -0.5);
  }

  std::size_t nearest(const Vec2& p, double beyond) const {
    std::size_t best = 0;
    double best_squared = INFINITY;
    for (std::size_t n = 0; n < place_.size(); ++n) {
      const Vec2 d = place_[n] - p;
      const double squared = dot(d, d);
      if (squared < best_squared && squared > beyond) {
        best = n;
        best_squared = squared;
      }
    }
    return best;
  }

  int degree_;
  std::span<const Vec2> control_;
  bool tiny_ = false;
  std::vector<Lambda> start_;
  std::vector<Vec2> place_;
};

/// The nearest reference point in the element (nearly: it moves by less than a pixel).
Lambda clamp_to_element(Lambda lambda) {
  double sum = 0.0;
  for (double& l : lambda) {
    l = std::max(l, 0.0);
    sum += l;
  }
  for (double& l : lambda) l /= sum;
  return lambda;
}

std::vector<Sample> sample_element(const FieldPaint& paint, ElementId e, int width, int height) {
  const TriangleMesh& mesh = paint.field->mesh();
  const std::vector<Vec2> control = mesh.gather(e);
  std::vector<Vec2> on_screen(control.size());
  std::transform(control.begin(), control.end(), on_screen.begin(),
                 [&](const Vec2& p) { return paint.viewport(p); });

  Box2 box;
  std::vector<Vec2> outline;
  for (int side = 0; side < 3; ++side)
    flatten(bernstein::side<Vec2>(mesh.degree(), std::span<const Vec2>(on_screen), side),
            outline_tolerance, outline);
  for (const Vec2& p : outline) box.include(p);
  AreaCoverage area;
  area.reset(box);
  for (std::size_t i = 0; i < outline.size(); ++i)
    area.edge(outline[i == 0 ? outline.size() - 1 : i - 1], outline[i]);
  area.finish();

  std::vector<Sample> samples;
  std::vector<Lambda> lambda;
  std::vector<Vec2> place;
  const Inverter inverter(mesh.degree(), control, 1.0 / paint.viewport.scale);
  // Reference points found in the row above, for warm starts.
  std::vector<Lambda> above(static_cast<std::size_t>(area.width()));
  std::vector<char> known(static_cast<std::size_t>(area.width()), 0);
  for (int row = 0; row < area.height(); ++row) {
    const int y = area.y0() + row;
    for (int column = 0; column < area.width(); ++column) {
      const int x = area.x0() + column;
      const auto c = static_cast<std::size_t>(column);
      const double cover = std::abs(area.value(column, row));
      if (cover < least_cover || x < 0 || y < 0 || x >= width || y >= height) {
        known[c] = 0;
        continue;
      }
      const Vec2 p = paint.viewport.inverse(Vec2{{x + 0.5, y + 0.5}});
      const Lambda* warm = column > 0 && known[c - 1] != 0 ? &above[c - 1]
                           : known[c] != 0                 ? &above[c]
                                                           : nullptr;
      above[c] = inverter(p, cover > 1.0 - least_cover, warm);
      known[c] = 1;
      samples.push_back({static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                             static_cast<std::size_t>(x),
                         cover, Colour{}});
      lambda.push_back(clamp_to_element(above[c]));
      place.push_back(p);
    }
  }
  if (samples.empty()) return samples;

  // A polynomial in x and y is asked at the pixel itself, or where the clamping moved it.
  for (std::size_t q = 0; q < samples.size(); ++q)
    if (samples[q].cover < 1.0 - least_cover)
      place[q] =
          bernstein::evaluate<Vec2>(mesh.degree(), std::span<const Vec2>(control), lambda[q]);
  std::vector<double> value(samples.size());
  ElementScalar scalar(*paint.field, paint.component);
  scalar.move_to(e);
  scalar.evaluate(lambda, place, value);
  for (std::size_t q = 0; q < samples.size(); ++q)
    samples[q].colour = (*paint.map)((value[q] - paint.lo) / (paint.hi - paint.lo));
  return samples;
}

}  // namespace

FieldPixels paint_field(const FieldPaint& paint, int width, int height) {
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  FieldPixels result{std::vector<double>(3 * pixels, 0.0), std::vector<double>(pixels, 0.0)};
  const std::size_t elements = paint.field->mesh().element_count();
  // Elements are sampled in parallel, a batch at a time to bound memory, and summed in their order.
  constexpr std::size_t batch = 512;
  std::vector<std::vector<Sample>> samples(std::min(batch, elements));
  for (std::size_t first = 0; first < elements; first += batch) {
    const std::size_t count = std::min(batch, elements - first);
    parallel_for(count, [&](std::size_t i) {
      samples[i] = sample_element(paint, ElementId(first + i), width, height);
    });
    for (std::size_t i = 0; i < count; ++i)
      for (const Sample& s : samples[i]) {
        result.rgb[3 * s.pixel] += s.cover * s.colour.r;
        result.rgb[3 * s.pixel + 1] += s.cover * s.colour.g;
        result.rgb[3 * s.pixel + 2] += s.cover * s.colour.b;
        result.cover[s.pixel] += s.cover;
      }
  }
  for (std::size_t q = 0; q < pixels; ++q) {
    double& cover = result.cover[q];
    if (cover <= 0.0) continue;
    for (std::size_t c = 0; c < 3; ++c) result.rgb[3 * q + c] /= cover;
    // Areas of neighbours sum to one up to rounding.
    cover = cover > 1.0 - 1e-5 ? 1.0 : cover;
  }
  return result;
}

}  // namespace bezel::view
