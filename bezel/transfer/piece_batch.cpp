#include "bezel/transfer/piece_batch.hpp"

#include <algorithm>

#include "bezel/bernstein/index.hpp"

// Few targets, for the sake of those who build this.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bezel/transfer/piece_batch.cpp"
#include "hwy/foreach_target.h"
// clang-format off
#include "hwy/highway.h"
// clang-format on
#include "bezel/transfer/vector_lanes.hpp"

HWY_BEFORE_NAMESPACE();
namespace bezel::detail::HWY_NAMESPACE {

/// Points of the blossom with k parameters s and the others r, k = 0 .. G: the part's control
/// points.
template <int G>
HWY_INLINE void part_control(const Lanes* p, const Lanes& r, const Lanes& s, Lanes* out) {
  const Lanes one = Lanes{} + 1.0;
  const Lanes r_left = one - r, s_left = one - s;
#pragma GCC unroll 4
  for (int k = 0; k <= G; ++k) {
    Lanes q[G + 1];
#pragma GCC unroll 4
    for (int i = 0; i <= G; ++i) q[i] = p[i];
#pragma GCC unroll 4
    for (int level = 0; level < G; ++level) {
#pragma GCC unroll 4
      for (int i = 0; i < G - level; ++i) {
        if (level < G - k)
          q[i] = mul_add(r_left, q[i], r * q[i + 1]);
        else
          q[i] = mul_add(s_left, q[i], s * q[i + 1]);
      }
    }
    out[k] = q[0];
  }
}

/// Coordinates of eight pieces' elements.
struct CoordinateLanes {
  Lanes centre_x, centre_y, first_x, first_y, second_x, second_y;
};

HWY_INLINE CoordinateLanes coordinates_of(const TargetPlaces& places, const std::int64_t* owner) {
  return {pick(places.centre_x.data(), owner), pick(places.centre_y.data(), owner),
          pick(places.first_x.data(), owner),  pick(places.first_y.data(), owner),
          pick(places.second_x.data(), owner), pick(places.second_y.data(), owner)};
}

/// Those of the plane about the elements' origins.
HWY_INLINE CoordinateLanes plane_of(const TargetPlaces& places, const std::int64_t* owner) {
  const Lanes none{};
  return {pick(places.origin_x.data(), owner),
          pick(places.origin_y.data(), owner),
          none + 1.0,
          none,
          none,
          none + 1.0};
}

/// The pieces' control points in these coordinates.
template <int G>
HWY_INLINE void local_control(const PieceBatch& batch, std::size_t block,
                              const CoordinateLanes& place, Lanes* a, Lanes* b) {
  Lanes from, to, u[G + 1], v[G + 1];
  from = load(batch.from.data() + block);
  to = load(batch.to.data() + block);
#pragma GCC unroll 4
  for (int i = 0; i <= G; ++i) {
    Lanes x, y;
    x = load(batch.x.data() + static_cast<std::size_t>(i) * batch.stride + block);
    y = load(batch.y.data() + static_cast<std::size_t>(i) * batch.stride + block);
    x -= place.centre_x;
    y -= place.centre_y;
    u[i] = mul_add(place.first_x, x, place.first_y * y);
    v[i] = mul_add(place.second_x, x, place.second_y * y);
  }
  part_control<G>(u, from, to, a);
  part_control<G>(v, from, to, b);
}

/// Numbers per piece and region with moments up to degree D: these, the step, the area of curved
/// pieces, and padding.
template <int G, int D>
constexpr std::size_t width_of = sums_width(static_cast<std::size_t>(bernstein::triangle_size(D)),
                                            G > 1);

template <int G, int D>
void piece_moments_of(const PieceTable& table, const std::vector<double>& weights,
                      const TargetPlaces& places, PieceBatch& batch) {
  constexpr std::size_t size = static_cast<std::size_t>(bernstein::triangle_size(D));
  constexpr std::size_t width = width_of<G, D>;
  for (std::size_t block = 0; block < batch.stride; block += lanes) {
    Lanes a[G + 1], b[G + 1];
    const std::int64_t* const owner = batch.owner.data() + block;
    local_control<G>(batch, block, coordinates_of(places, owner), a, b);
    Lanes sums[width] = {};
    for (int q = 0; q < table.points; ++q) {
      Lanes x, y, k;
      if constexpr (G == 1) {
        const double t = table.parameter[static_cast<std::size_t>(q)];
        x = mul_add(t, a[1] - a[0], a[0]);
        y = mul_add(t, b[1] - b[0], b[0]);
        k = table.weight[static_cast<std::size_t>(q)] * (a[0] * b[1] - b[0] * a[1]);
      } else {
        Lanes dx{}, dy{};
        x = y = dx;
        const double* value = table.value.data() + q;
        const double* slope = table.slope.data() + q;
#pragma GCC unroll 4
        for (int i = 0; i <= G; ++i) {
          const double f = value[static_cast<std::size_t>(i) * table.stride];
          const double d = slope[static_cast<std::size_t>(i) * table.stride];
          x = mul_add(f, a[i], x);
          y = mul_add(f, b[i], y);
          dx = mul_add(d, a[i], dx);
          dy = mul_add(d, b[i], dy);
        }
        k = x * dy - y * dx;
      }
      std::size_t n = 0;
#pragma GCC unroll 8
      for (int j = 0; j <= D; ++j) {
        Lanes term = k;
#pragma GCC unroll 8
        for (int i = 0; i <= D - j; ++i, ++n) {
          sums[n] += term;
          term *= x;
        }
        k *= y;
      }
    }
    std::size_t n = 0;
#pragma GCC unroll 8
    for (int j = 0; j <= D; ++j) {
#pragma GCC unroll 8
      for (int i = 0; i <= D - j; ++i, ++n) sums[n] *= 1.0 / static_cast<double>(i + j + 2);
    }
    sums[size] = a[G] - a[0];
    sums[size + 1] = b[G] - b[0];
    if constexpr (G == 1) {
      sums[0] = 0.5 * (a[0] * sums[size + 1] - b[0] * sums[size]);
    } else {
      // The area in the plane, whatever the coordinates and the degree: that of the chord, and of
      // what lies between it and the piece.
      local_control<G>(batch, block, plane_of(places, owner), a, b);
      Lanes twice = a[0] * (b[G] - b[0]) - b[0] * (a[G] - a[0]);
      std::size_t w = G;
#pragma GCC unroll 4
      for (int i = 1; i < G; ++i)
#pragma GCC unroll 4
        for (int j = i + 1; j <= G; ++j, ++w)
          twice += weights[w] * ((a[i] - a[0]) * (b[j] - b[0]) - (b[i] - b[0]) * (a[j] - a[0]));
      sums[size + 2] = 0.5 * twice;
    }
    double* out = batch.moments.data() + block * width;
#pragma GCC unroll 4
    for (std::size_t m = 0; m < width; m += lanes) {
      transpose(sums + m);
#pragma GCC unroll 8
      for (std::size_t l = 0; l < lanes; ++l) store(sums[m + l], out + l * width + m);
    }
  }
}

/// A piece counts for the region on its left, and backwards for that on its right.
template <std::size_t width>
void sum_pieces(std::span<const BoundaryPiece> pieces, const double* row, double* sums) {
  for (const BoundaryPiece& piece : pieces) {
    double* left = sums + static_cast<std::size_t>(piece.left) * width;
    double* right =
        piece.right < 0 ? nullptr : sums + static_cast<std::size_t>(piece.right) * width;
#pragma GCC unroll 4
    for (std::size_t m = 0; m < width; m += lanes) {
      Lanes moments, sum;
      moments = load(row + m);
      sum = load(left + m);
      store(sum + moments, left + m);
      if (right == nullptr) continue;
      sum = load(right + m);
      store(sum - moments, right + m);
    }
    row += width;
  }
}

template <int G, int D>
void region_sums_of(const PieceTable& table, const TargetPlaces& places,
                    std::span<const BoundaryPiece> pieces, std::span<const ElementCount> elements,
                    PieceBatch& batch) {
  constexpr std::size_t width = width_of<G, D>;
  batch.width = width;
  constexpr auto moments = static_cast<std::size_t>(bernstein::triangle_size(D));
  batch.open = sums_open(moments);
  batch.area = sums_area(moments, G > 1);
  batch.area_in_units = G == 1;
  std::size_t regions = 0;
  for (const ElementCount& element : elements) regions += element.regions;
  if (batch.moments.size() < batch.stride * width) batch.moments.resize(2 * batch.stride * width);
  if (batch.sums.size() < regions * width) batch.sums.resize(2 * regions * width);
  piece_moments_of<G, D>(table, area_weights(G), places, batch);
  std::fill_n(batch.sums.data(), regions * width, 0.0);
  double* sums = batch.sums.data();
  std::size_t piece = 0;
  for (const ElementCount& element : elements) {
    sum_pieces<width>(pieces.subspan(piece, element.pieces), batch.moments.data() + piece * width,
                      sums);
    piece += element.pieces;
    sums += element.regions * width;
  }
}

template <int G>
void region_sums_degree(const PieceTable& table, int degree, const TargetPlaces& places,
                        std::span<const BoundaryPiece> pieces,
                        std::span<const ElementCount> elements, PieceBatch& batch) {
  switch (degree) {
    case 0:
      return region_sums_of<G, 0>(table, places, pieces, elements, batch);
    case 2:
      return region_sums_of<G, 2>(table, places, pieces, elements, batch);
    case 4:
      return region_sums_of<G, 4>(table, places, pieces, elements, batch);
    default:
      return region_sums_of<G, 6>(table, places, pieces, elements, batch);
  }
}

void region_sums_target(const PieceTable& table, int degree, const TargetPlaces& places,
                        std::span<const BoundaryPiece> pieces,
                        std::span<const ElementCount> elements, PieceBatch& batch) {
  if (table.degree == 1)
    return region_sums_degree<1>(table, degree, places, pieces, elements, batch);
  if (table.degree == 2)
    return region_sums_degree<2>(table, degree, places, pieces, elements, batch);
  return region_sums_degree<3>(table, degree, places, pieces, elements, batch);
}

}  // namespace bezel::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bezel::detail {

HWY_EXPORT(region_sums_target);

void PieceBatch::resize(std::size_t pieces, int degree) {
  count = pieces;
  const std::size_t needed = padded_to_lanes(pieces);
  stride = needed;
  const auto points = static_cast<std::size_t>(degree + 1);
  if (from.size() < needed) {
    from.resize(2 * needed);
    to.resize(2 * needed);
    owner.resize(2 * needed);
  }
  if (x.size() < points * needed) {
    x.resize(2 * points * needed);
    y.resize(2 * points * needed);
  }
}

void region_sums(const PieceTable& table, int degree, const TargetPlaces& places,
                 std::span<const BoundaryPiece> pieces, std::span<const ElementCount> elements,
                 PieceBatch& batch) {
  HWY_DYNAMIC_DISPATCH(region_sums_target)(table, degree, places, pieces, elements, batch);
}

}  // namespace bezel::detail
#endif
