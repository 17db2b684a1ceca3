#pragma once
// The second stage of a curve-curve intersection: common points of two curves where one is a graph
// over x or y, however nearly parallel they are. Internal.
//
// With t = t_c + phi(h) following the curve b opposite a(s_c + h), a common point at t + w has
//   E(h) = cross(b'(t), a - b(t)) = O(w^2),
// so that everything is decided by one polynomial, whose coefficients are computed exactly, up to a
// remainder that shrinks with the fourth power of the interval.

#include <cstdint>
#include <optional>
#include <vector>

#include "bezel/geometry/exact_curve.hpp"

namespace bezel::geometry_kernel {

/// Covers the rounding of a few hundred operations.
inline constexpr double up = 1.0 + 0x1p-40;

/// A common point that the exact stage has found.
struct ResolvedRoot {
  double s, t;
  double s_lo, s_hi, t_lo, t_hi;  ///< no other common point in this box
  int order;          ///< multiplicity: 1 transversal; 0: at a verified place, its order not found
  int sign;           ///< of cross(a', b') when the order is 1
  double turn;        ///< |cross(a', b')|, of the scaled curves
  bool s_end, t_end;  ///< s or t is exactly 0 or 1
  bool rough;         ///< s and t are from the first stage
  int contact_sign = 0;  ///< of an odd order above 1: which way they cross, as `sign`
};

struct Undecided {
  double s0, s1, t0, t1;
  const char* reason;
};

struct Resolution {
  std::vector<ResolvedRoot> roots;
  std::vector<Undecided> undecided;
  /// Unless it is there already. @param root  not rough
  void add(const ResolvedRoot& root);
};

class TubeSearch {
 public:
  /// b' [axis] keeps its sign for t in [t_centre - t_radius, t_centre + t_radius].
  ///
  /// @param swapped  a and b are exchanged: results are reported for the curves in their order
  /// @param nodes    work left, counted down
  TubeSearch(const ExactCurve& a, const ExactCurve& b, bool swapped, int& nodes, Resolution& out);

  /// Whether b is such a graph over [t0, t1] enlarged; prepares `run`.
  bool graph(double t0, double t1);
  /// All common points in [s0, s1] x [t0, t1].
  void run(double s0, double s1);

 private:
  struct Node {
    Dyadic centre;
    double h;
    int halvings;
    Dyadic opposite;  // near b's parameter
    bool certified;   // holds exactly one root, or one beyond its border
    double unique_lo, unique_hi;
  };
  struct Suspect {
    double lo, hi;
  };
  /// Intervals are not made smaller than this: beyond, points are told apart only exactly.
  static constexpr double smallest_radius = 0x1p-200;
  struct Model {
    Dyadic t;                     // b's parameter opposite the centre
    std::vector<double> phi;      // b's parameter is t + phi(h) + w
    double width;                 // of w
    std::vector<double> e;        // E in units of the node's radius
    double remainder, noise;      // of E: by w, by rounding
    double derivative_remainder;  // of E' as cross(b', a'), with respect to h
  };
  void visit(const Node& node);
  Dyadic find_opposite(const Dyadic& x, const Dyadic& start, double target) const;
  bool build(const Node& node, const ExactTaylor& a, const Dyadic& opposite, int order,
             Model& model) const;
  void search(const std::vector<double>& e, double centre, double radius, int level,
              const Model& model, std::vector<Suspect>& out) const;
  void examine(const Node& node, const Model& model, const Suspect& suspect);
  void push_interval(const Dyadic& lo, const Dyadic& hi, const Node& from);
  void leave(const Node& node, const char* reason);
  void emit(ResolvedRoot root);

  // At places known exactly (tube_contacts.cpp).
  bool try_contact(const Node& node, const Dyadic& s_lo, const Dyadic& s_hi, const Dyadic& t_lo,
                   const Dyadic& t_hi, bool certified);
  bool try_straight(const Node& node, const Dyadic& s_lo, const Dyadic& s_hi);
  void finish_root(const Node& node, const Dyadic& s, double s_error, const Dyadic& t,
                   double t_error, int sign, double turn);

  const ExactCurve &a_, &b_;
  bool swapped_;
  int& nodes_;
  Resolution& out_;
  int axis_ = 0;
  double s0_ = 0, s1_ = 0, t0_ = 0, t1_ = 0;
  double t_centre_ = 0, t_radius_ = 0;
  double slowest_ = 0, speed_ = 0;  // of b on the enlarged interval
  Dyadic x_lo_, x_hi_;              // range of b[axis] on [t0, t1]
  std::vector<Node> stack_;
};

}  // namespace bezel::geometry_kernel
