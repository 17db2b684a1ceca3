#pragma once
// Other libraries in the same run. Each is there only when it was found while building.

#include <span>
#include <vector>

#include "bezel/numeric/vec.hpp"

namespace peers {

struct Parameters {
  double s, t;
};

#ifdef BEZEL_BENCH_LIB2GEOM
/// The precision that lib2geom asks of itself unless told otherwise.
inline constexpr double lib2geom_default = 1e-6;
/// Bezier clipping; any degree. False when it threw.
bool lib2geom_intersect(std::span<const bezel::Vec2> a, std::span<const bezel::Vec2> b,
                        double precision, std::vector<Parameters>& out);
void lib2geom_evaluate(std::span<const bezel::Vec2> c, std::span<const double> s,
                       std::span<bezel::Vec2> out);
#endif

#ifdef BEZEL_BENCH_LYON
extern "C" {
int peer_lyon_cubics(const double* a, const double* b, double* out);
int peer_lyon_quadratics(const double* a, const double* b, double* out);
void peer_lyon_sample(const double* c, const double* s, std::size_t count, double* out);
}
/// Degrees 2 and 3. False when it panicked.
inline bool lyon_intersect(std::span<const bezel::Vec2> a, std::span<const bezel::Vec2> b,
                           std::vector<Parameters>& out) {
  double found[18];
  out.clear();
  const int count = (a.size() == 4 ? peer_lyon_cubics : peer_lyon_quadratics)(
      a.data()->c.data(), b.data()->c.data(), found);
  for (int i = 0; i < count; ++i) out.push_back({found[2 * i], found[2 * i + 1]});
  return count >= 0;
}
#endif

}  // namespace peers
