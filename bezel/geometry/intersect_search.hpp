#pragma once
// Curve-curve intersection with a coincidence distance (without one: intersect_exact.hpp). The
// working state shared by its stages: end points near the other curve (intersect_contacts.cpp),
// subdivision with a test for at most one transversal root (intersect_search.cpp), and the signed
// distance of nearly parallel pieces (intersect_parallel.cpp).

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "bezel/geometry/curve.hpp"
#include "bezel/geometry/curve_kernel.hpp"

namespace bezel::geometry_kernel {

/// An end point of one curve lying on the other (within the coincidence distance, or to rounding).
struct Contact {
  double s, t;
  bool a_end, b_end;  ///< which of the two is an end point there
  int sign = 0;
  bool certified = false;
  bool in_overlap = false;
};

/// A pair of pieces, nearly parallel, waiting for the second stage.
struct ParallelBox {
  double s0, s1, t0, t1;
};

/// Where nearly parallel pieces end while the curves are together: [s0, s1] on a, the state (sign
/// of the distance) before and after, 0 where it lies beyond the pieces.
struct HalfEvent {
  double s0, s1, t;
  int before, after;
  bool reversed;
};

/// A part of a curve, with what the rejection tests need.
struct CurvePiece {
  const Vec2* p;
  double lo, hi;  // the curve's parameters
  int depth;      // halvings
  double box_lo_x, box_hi_x, box_lo_y, box_hi_y;
  Vec2 chord;
  double band_lo, band_hi;  // range of cross(chord, p_i - p_0)

  double extent() const { return std::max(box_hi_x - box_lo_x, box_hi_y - box_lo_y); }
};

/// Parameters in (0, 1) where the curve passes within tau of p; bits that depend on these alone.
/// @return  how many, at most four
int inner_feet(const Vec2& p, const CurveCache& curve, double tau, std::array<double, 4>& feet);

class IntersectSearch {
 public:
  IntersectSearch(const CurveCache& a, const CurveCache& b, const IntersectOptions& options,
                  CurveIntersections& out);
  void run();

 private:
  // Contacts (intersect_contacts.cpp).
  void find_contacts();
  void find_contact(const Vec2& p, const CurveCache& curve, bool of_a, double end);
  bool is_point(const CurveCache& curve) const;
  void add_contact(double s, double t, bool a_end, bool b_end);
  bool find_overlaps();
  bool coincide(const Contact& p, const Contact& q, double& gap) const;

  // Subdivision (intersect.cpp).
  enum class Outcome { none, one, open };
  template <int M, int N>
  Outcome transversal(const CurvePiece& a, const CurvePiece& b);
  enum class Newton { root, none, lost };
  /// Runs to the one root of a box that holds at most one; none: it lies outside.
  Newton newton(double& s, double& t, double s0, double s1, double t0, double t1) const;
  /// Newton's method with compensated residuals inside the box; false, and nothing changed, when it
  /// leaves the box or does not settle.
  bool polish(double& s, double& t, double s0, double s1, double t0, double t1) const;
  template <int M, int N>
  void descend(const CurvePiece& a, const CurvePiece& b);
  template <int M, int N>
  void descend_all();
  void add_crossing(double s, double t, double s0, double s1, double t0, double t1, int sign,
                    bool certified);
  void unresolved(double s0, double s1, double t0, double t1, const char* reason);
  void finish();

  // Nearly parallel pieces (intersect_parallel.cpp).
  bool graph_like(const Vec2* pa, const Vec2* pb) const;
  void resolve_parallel();
  void resolve_cluster(std::span<const ParallelBox> boxes);
  void join_halves();
  void analyse(double s0, double s1, double t0, double t1);
  friend class ParallelPair;

  const CurveCache &ca_, &cb_;
  const int m_, n_;
  const Vec2 *a_, *b_;
  CurveIntersections& out_;
  double tol_;        // the caller's coincidence distance
  double magnitude_;  // largest |coordinate| of both curves
  double rounding_;   // 2 u magnitude
  double tau_;        // distance that counts as touching: max(tol, rounding)
  double margin_;     // boxes further apart than this hold nothing
  double size_;       // extent of the smaller curve
  double shallow_;  // sine below which a crossing may count as an overlap: left to the second stage
  int parallel_depth_;
  int work_ = 0;
  std::array<Contact, 16> contacts_;
  int contact_count_ = 0;
  std::vector<ParallelBox> parallel_;
  std::vector<HalfEvent> halves_;
  std::uint64_t polished_ = 0;  // bit i: crossing i is; beyond 64 they count as not polished
};

}  // namespace bezel::geometry_kernel
