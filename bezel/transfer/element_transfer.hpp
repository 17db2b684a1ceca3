#pragma once
// Internal: right-hand sides, masses and coefficients of one target element from the segments of
// its overlay.

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "bezel/field/field.hpp"
#include "bezel/geometry/triangle.hpp"
#include "bezel/numeric/quadrature.hpp"
#include "bezel/transfer/element_batch.hpp"
#include "bezel/transfer/extension.hpp"
#include "bezel/transfer/group.hpp"
#include "bezel/transfer/mass_rule.hpp"
#include "bezel/transfer/moments.hpp"
#include "bezel/transfer/overlay.hpp"
#include "bezel/transfer/pair_fit.hpp"
#include "bezel/transfer/piece_batch.hpp"
#include "bezel/transfer/refilled.hpp"
#include "bezel/transfer/thin_region.hpp"
#include "bezel/transfer/transfer.hpp"

namespace bezel::detail {

/// What one target element received.
struct ElementOutcome {
  double covered_area = 0, uncovered_area = 0;
  double partition_residual = 0;  ///< relative to the element's area
  double max_joint_gap = 0;
  double max_mass_defect = 0;  ///< largest over components of |mass of the result - mass received|
  std::int32_t pairs = 0;
  double solve_seconds = 0;   ///< measured on every 16th element and multiplied
  bool inconsistent = false;  ///< the pieces around some T n D do not close
  ExtensionReport extension;
};

/// Areas that donor elements gave, and masses for the balance of what lies outside the target: one
/// entry a pair.
struct GivenList {
  std::vector<std::int32_t> donor;
  std::vector<std::int32_t> target;
  std::vector<double> area;
  std::vector<std::int32_t> massed;  ///< entries whose masses are kept
  std::vector<double> mass;          ///< per such entry all groups' components in order
};

/// The pairs of one target element kept apart: what each donor's basis functions give it.
struct ElementBlocks {
  std::size_t columns = 0;               ///< per pair
  std::vector<std::int32_t> donor;       ///< per pair, each donor once
  std::vector<double> product;           ///< per pair [n][column]: integrals of m_n psi
  std::vector<double> mass;              ///< per pair [column]: mass received
  std::vector<double> value;             ///< [n][pair][column]: coefficients of the result
  std::vector<std::int32_t> made_donor;  ///< donors extended into what none covers
  std::vector<double> made;              ///< per such donor [column]: mass made
  double area = 0;                       ///< of all that the element received

  void reset(std::size_t with_columns);
  /// Adds sign * change to what donor d gave, or to what was made of it.
  void move_mass(std::int32_t d, double sign, std::span<const double> change, bool is_made);
};

/// Per-thread worker.
class ElementTransfer {
 public:
  ElementTransfer(const OverlayMesh& donor, const OverlayMesh& target, const FrontSearch& search,
                  std::span<Group> groups, Uncovered policy);

  /// Integrates and solves on target element t; appends to `given`; `made` (all components) is
  /// added to. With `blocks` the only group is one of basis functions, and the pairs' results go
  /// there instead of being added up.
  ElementOutcome process(std::int32_t t, const ElementPieces& own, GivenList& given,
                         std::span<double> made, ElementBlocks* blocks = nullptr);
  /// Works on some of the elements from number `first` of the list on together, where they are
  /// ordinary: nothing but time depends on how many.
  /// @return how many of them have been looked at, at most eight; those of which together(k) holds
  ///         are ready for take(k), the others want process()
  std::size_t begin_together(std::span<const std::int32_t> elements, const OverlayList& overlays,
                             std::size_t first);
  bool together(std::size_t k) const { return together_.ready[k]; }
  ElementOutcome take(std::size_t k, std::int32_t t, const ElementPieces& own, GivenList& given);
  /// From now on only masses given by these donor elements are kept (nonzero; empty: all).
  void keep_masses_of(std::span<const std::uint8_t> donors) { keep_masses_of_ = donors; }

 private:
  struct Node {
    Vec2 x, dx;                       // point and derivative times weight, in the plane
    std::array<double, 2> q{}, dq{};  // the same in reference coordinates, when used
  };
  struct Accumulators {
    Refilled<double> product, basis, mass;
    void reset(std::size_t functions, std::size_t components, std::size_t padding = 0);
  };
  /// Cholesky factor of a target mass matrix, up to a factor of the matrix, the inverses of its
  /// diagonal, and integrals of the basis functions.
  struct Factor {
    std::vector<double> lower, inverse, integrals;
    double scale = 1.0;
  };

  // What is known of an element, or of a region, while it is worked on is in one object. Before the
  // next a new one is assigned to it as a whole, so that nothing is left of the one before; its
  // lists keep their storage.

  /// A straight piece across an open joint, from the shape's origin.
  struct Bridge {
    Vec2 from, step;
  };
  /// The boundary of a region.
  struct RegionShape {
    std::span<const Segment> run;
    Vec2 origin;    ///< of the points before they were moved to the centre
    Vec2 centre;    ///< mean of the corners
    Vec2 relative;  ///< the same, from the origin
    double area = 0;
    double gap = 0;          ///< the widest open joint
    Refilled<Vec2> control;  ///< of the pieces and bridges, from the centre
    Refilled<int> degree;    ///< of each
    Refilled<Bridge> bridges;
  };
  struct RegionState {
    double area = 0;
    std::int32_t mass_row = -1;  ///< of the list of masses
    bool apart = false;  ///< by its own pieces: its joints are bridged, or its donor is small
    bool thin = false;   ///< goes by thin_shape() and add_thin_pair()
  };
  /// One group of fields on the element.
  struct GroupState {
    std::size_t functions = 0;  ///< of the target element
    bool has_moments = false, has_sums = false;
    Accumulators moments;    ///< with monomials, when has_moments
    Accumulators sums;       ///< with powers of barycentrics, of what is not in the moments, when
                             ///< has_sums
    Refilled<double> base;   ///< [component] taken off before integrating, and padding
    Refilled<double> whole;  ///< moments of all regions together: of batched groups on
                             ///< curved elements
    Refilled<double> region_mass;  ///< [region][component]
  };
  struct ElementState {
    explicit ElementState(std::size_t group_count) : groups(group_count) {}
    Vec2 origin;         ///< of the pieces' control points
    bool loose = false;  ///< joints may be open a little
    Refilled<RegionState> regions;
    Refilled<double> masses;  ///< received: all groups' components in order, and padding
    std::vector<GroupState> groups;
    bool has_segments = false;
    Refilled<Segment> segments;     ///< of all regions, one after the other, when has_segments
    Refilled<std::size_t> run_end;  ///< by region: likewise
  };
  /// Of elements that are worked on together.
  struct BatchState {
    std::array<bool, lanes> ready{};
    bool all_ready = false;
    bool solved = false;
    TargetPlaces::Row defect{};  ///< of masses, when solved
    double seconds = 0;          ///< that the solutions took
  };
  /// One group of fields on these elements, filled as a whole.
  struct GroupBatch {
    ElementSums sums;
    std::vector<double> base;   ///< [element][component] and padding
    std::vector<double> whole;  ///< on curved elements: [element][n], GroupState::whole of each
  };

  const IntervalRule& rule(int points);
  void begin_element(std::int32_t t, bool loose);
  void boundary_nodes(const RegionShape& shape, int degree);
  /// Valid until the next call.
  const RegionShape& shape_of(std::int32_t t, std::int32_t d, std::span<const Segment> run);
  /// Whether masses about a place in the target would be known to its rounding rather than the
  /// donor's.
  bool is_small_donor(std::int32_t d, std::int32_t t) const;
  /// Of the pieces about where they are taken from.
  static double twice_piece_area(const RegionShape& shape);
  double bridge_joints(RegionShape& shape);
  double close_joints(RegionShape& shape);
  /// Starts and steps of bridges in the plane.
  std::span<const std::array<Vec2, 2>> plane_bridges(const RegionShape& shape);
  void note_partition(std::int32_t t, double total, ElementOutcome& outcome) const;
  // Ordinary elements together (element_together.cpp).
  bool may_be_ordinary(std::int32_t t, const ElementPieces& own, std::size_t first_region);
  void sum_together(std::size_t group, std::span<const std::int32_t> elements,
                    std::span<const BoundaryPiece> pieces, std::span<const std::int32_t> donors);
  void fill_batch(PieceBatch& batch, std::span<const BoundaryPiece> pieces) const;
  void finish_groups(std::int32_t t, double integrated, bool batch, ElementBlocks* blocks,
                     ElementOutcome& outcome);
  bool is_closed(std::int32_t t, std::int32_t d, double gap) const;
  /// The row of the masses of the entry last added to the list, or -1 when they are not kept.
  std::int32_t add_mass_row(GivenList& given) const {
    const auto entry = given.donor.size() - 1;
    if (!keep_masses_of_.empty() &&
        keep_masses_of_[static_cast<std::size_t>(given.donor[entry])] == 0)
      return -1;
    given.massed.push_back(static_cast<std::int32_t>(entry));
    return static_cast<std::int32_t>(given.massed.size() - 1);
  }
  void give_strips(std::int32_t t, const ElementPieces& own, std::size_t components,
                   GivenList& given, std::span<double> made, ElementBlocks* blocks);
  double largest_partition_residual(std::int32_t t) const;
  // Thin elements that cross (element_thin.cpp).
  void find_thin_donors();
  bool is_thin_donor(std::int32_t d) const {
    return d != exterior && !thin_donor_.empty() && thin_donor_[static_cast<std::size_t>(d)] != 0;
  }
  bool has_thin_donor(const ElementPieces& own) const;
  /// The strip between both parts of a segment, about as give_strips() has it.
  void begin_thin_strip(std::int32_t t, std::int32_t d, const Segment& segment);
  double thin_strip_width(double s) const;
  /// Where its point on the target's part lies in a donor.
  std::array<double, 2> thin_strip_place(const Group& g, std::int32_t d, double s);
  LinearPlace thin_linear_place(const Group& g, std::int32_t d) const;
  ExactPlace exact_linear_place(const Group& g, std::int32_t d) const;
  bool is_straight_place(const Group& g, std::int32_t d) const;
  void find_thin_regions(std::int32_t t, const ElementPieces& own);
  /// As shape_of(), from the centre of thin_ and in its plane.
  const RegionShape& thin_shape(std::int32_t t, std::int32_t d, std::span<const Segment> run,
                                bool donors_plane);
  void note_thin_region(std::int32_t t, std::int32_t d, const RegionShape& shape,
                        ElementOutcome& outcome) const;
  void thin_nodes(int degree);
  /// Calls visit(weight, x) at the points of a rule that is exact for the given degree in the
  /// plane.
  template <class Visit>
  void thin_fan(int degree, const Visit& visit);
  /// `points` on each piece of a target edge.
  void thin_reference_nodes(std::int32_t d, std::span<const Segment> run, int degree, int points);
  template <class Visit>
  void thin_reference_fan(const std::array<double, 2>& centre, int degree, const Visit& visit);
  // Of bent elements (element_bent.cpp), the region at work as thin_shape() left it.
  bool is_bent_pair(std::int32_t t, std::int32_t d) const;
  /// Of the strip that begin_thin_strip() left, between places on either part.
  double bent_strip_width(double on_target, double on_donor) const;
  /// Its area; sets bent_joints_.
  double bent_region_area(std::span<const Segment> run);
  /// As reference_nodes(), in `own`, which is the donor (`source`) or the target.
  void bent_reference_nodes(const OverlayMesh& mesh, std::int32_t element, const BentElement& own,
                            bool source, std::span<const Segment> run, int degree, int points);
  /// Calls visit(weight, q) at points on the rays from a centre to the nodes, all in a reference
  /// triangle: the weights lack the Jacobian there.
  template <class Visit>
  void reference_rays(const std::array<double, 2>& centre, int degree, const Visit& visit);
  /// Whether products are integrated in the target's reference triangle.
  bool is_in_bent_target(const Group& g, std::int32_t t, std::int32_t d) const;
  void sum_in_bent_target(const Group& g, std::int32_t t, std::int32_t d,
                          std::span<const Segment> run, std::span<const double> constants,
                          Accumulators& sums);
  void add_thin_pair(const Group& g, std::int32_t t, std::int32_t d, std::span<const Segment> run,
                     double area, GroupState& own, std::span<double> mass);
  // By moments (element_moments.cpp).
  static bool by_moments(const Group& g, std::int32_t t, std::int32_t d);
  const PieceTable& piece_table(int degree, int moments);
  bool add_pair_moments(const Group& g, std::int32_t t, std::int32_t d, const RegionShape& shape,
                        GroupState& own, std::span<double> mass);
  /// By moments about the region's own centre, or by quadrature.
  void add_apart(std::size_t i, std::int32_t t, std::int32_t d, std::span<const Segment> run,
                 double area, bool thin, std::span<double> mass);
  void moments_to_powers(std::size_t i, std::int32_t t);
  /// Sets moments_ to those of target element t in its coordinates.
  void element_moments(const Group& g, std::int32_t t, int degree);
  bool moment_factor(const Group& g, std::int32_t t, std::span<const double> whole);
  static bool can_batch(const Group& g);
  static TargetPlace target_place(const Group& g, std::int32_t t);
  void begin_moments(std::size_t group);
  void begin_sums(std::size_t group);
  void choose_base(std::size_t group, const ElementPieces& own);
  template <std::size_t points>
  void fill_curves(PieceBatch& batch, std::span<const BoundaryPiece> pieces) const;
  /// Notes the regions' areas; returns whether the batch now holds the sums of group `first`.
  bool shape_regions(std::int32_t t, const ElementPieces& own, std::size_t first,
                     ElementOutcome& outcome);
  /// Group i on all regions, their sums already in the batch when `summed`.
  void add_batched(std::size_t i, std::int32_t t, const ElementPieces& own, bool summed);
  /// The segments around all regions, one region after the other.
  std::span<const Segment> all_runs(const ElementPieces& own);
  /// The segments around region k.
  std::span<const Segment> run_of(const ElementPieces& own, std::size_t k) {
    const auto all = all_runs(own);
    return all.subspan(run_begin(k), element_.run_end[k] - run_begin(k));
  }
  std::size_t run_begin(std::size_t k) const { return k == 0 ? 0 : element_.run_end[k - 1]; }
  void note_region(std::int32_t t, std::int32_t d, double area, double gap,
                   std::span<const Bridge> bridges, ElementOutcome& outcome) const;
  /// Sets shifted_ to a donor's coefficients less a constant for each component.
  void take_off(int degree, std::span<const double> scaled, std::span<const double> constants);
  /// Adds what the points give with a donor's polynomial less the constants.
  void flush(const Group& g, std::int32_t d, int target_degree, std::span<const double> constants,
             Accumulators& sums);
  void add_pair(const Group& g, std::int32_t t, std::int32_t d, const RegionShape& shape,
                double area, GroupState& own, std::span<double> mass);
  void add_extension(const Group& g, std::int32_t t, const RegionShape& shape, double area,
                     GroupState& own, std::span<double> made, ExtensionReport& report);
  /// Calls visit(weight, target place, donor, donor place) at the points of a rule for the part of
  /// t that no donor covers.
  template <class Visit>
  void extension_points(const Group& g, std::int32_t t, const RegionShape& shape,
                        ExtensionReport& report, const Visit& visit);
  void extension_blocks(const Group& g, std::int32_t t, const RegionShape& shape, double area,
                        Accumulators& sums, ElementBlocks& blocks, ExtensionReport& report);
  static void keep_pair(std::int32_t d, Accumulators& sums, std::span<const double> mass,
                        ElementBlocks& blocks);
  void finish_blocks(const Group& g, std::int32_t t, Accumulators& sums, double area,
                     ElementBlocks& blocks, ElementOutcome& outcome);
  /// Solves for mass.size() components into result, [n][component].
  /// @param base  [component] constants that the sums lack
  /// @param whole  as for factor()
  void finish(const Group& g, std::int32_t t, const Accumulators& sums,
              std::span<const double> whole, std::span<const double> mass,
              std::span<const double> base, double area, std::span<double> result,
              ElementOutcome& outcome);
  /// The same for group i on a covered straight element, when it went by moments alone.
  bool finish_straight(std::size_t i, std::int32_t t, std::span<const double> mass, double area,
                       std::span<double> result, ElementOutcome& outcome);
  struct Solution;
  /// As finish(), for up to `width` components from number c0 on.
  template <std::size_t width>
  static void finish_components(const Solution& s, const Accumulators& sums,
                                std::span<const double> mass, std::span<const double> base,
                                std::size_t c0, std::span<double> result, ElementOutcome& outcome);
  const MassRule& mass_rule(int degree);
  const MappedMass& mapped_mass(int degree);
  static bool factorize(std::size_t n, Factor& factor);
  /// @param whole  moments of the element up to twice the degree, when known
  const Factor& factor(const Group& g, std::int32_t t, std::span<const double> whole);
  /// Makes room for `more` points in the arrays.
  void reserve_points(std::size_t more);
  /// Takes the points from number `first` to `last` out.
  void drop_points(std::size_t first, std::size_t last);
  void push(double w, double tu, double tv, double du, double dv) {
    const std::size_t i = count_++;
    w_[i] = w;
    tu_[i] = tu;
    tv_[i] = tv;
    du_[i] = du;
    dv_[i] = dv;
  }
  std::array<double, 2> target_place(const Group& g, std::int32_t t, const Vec2& x) const;
  /// Fills in where the points of plane_, the quadrature points from number `first` on, lie in d.
  /// False where a map could not be inverted.
  bool donor_places(const Group& g, std::int32_t d, std::size_t first);
  std::array<double, 2> donor_place(const Group& g, std::int32_t d, const Vec2& x,
                                    std::array<double, 3>& warm, bool& have_warm) const;
  void reference_nodes(const OverlayMesh& mesh, std::int32_t element, const RegionShape& shape,
                       bool source, int degree);
  /// Nodes along a part of an element's own side, which is straight in the reference triangle.
  void own_side_nodes(const OverlayMesh& mesh, std::int32_t element, const Part& own, int degree);
  std::array<double, 2> reference_centre() const;  // mean of the reference nodes
  template <class Visit>
  void reference_fan(const OverlayMesh& mesh, std::int32_t element,
                     const std::array<double, 2>& centre, int degree, const Visit& visit);

  const OverlayMesh& donor_;
  const OverlayMesh& target_;
  const FrontSearch& search_;
  std::span<Group> groups_;
  Uncovered policy_;
  std::span<const std::uint8_t> keep_masses_of_;
  std::vector<std::uint8_t> batched_;         // by group: goes by add_batched
  std::vector<std::uint8_t> fitted_;          // by group: goes by fit_
  bool some_together_ = false;                // the meshes and groups allow it
  std::uint64_t elements_ = 0, batches_ = 0;  // done so far

  ElementState element_;
  const ElementState no_element_;  // with the groups
  RegionShape shape_;
  BatchState together_;
  ElementBatch ordinary_;
  std::vector<GroupBatch> group_batches_;
  PieceBatch batch_;  // of the element's pieces
  PairFit fit_;
  std::vector<std::uint8_t> thin_donor_;  // by donor element; empty: none is thin
  ThinRegion thin_;                       // of the region at work, and elements brought there
  MappedElement thin_donor_map_, thin_target_map_;
  bool bent_ = false;  // the region at work is one of a bent element; then it has besides
  std::vector<ExactVec2> bent_control_;                // of the pieces, from the centre
  std::vector<std::array<ExactVec2, 2>> bent_joints_;  // where they end and begin
  BentElement bent_donor_, bent_target_;

  // Tables.
  std::vector<IntervalRule> rules_;
  std::vector<std::unique_ptr<PieceTable>> tables_;
  std::vector<MassRule> mass_rules_;
  std::deque<MappedMass> mapped_masses_;

  // Room that is filled before each use.
  std::vector<Node> nodes_;
  std::vector<Vec2> local_control_;
  std::vector<std::array<Vec2, 2>> plane_bridges_;
  std::vector<Vec2> piece_starts_, piece_ends_;
  std::vector<MomentPiece> moment_pieces_;
  std::vector<double> moments_;
  std::vector<BatchRegion> regions_;
  std::vector<double> w_, tu_, tv_, du_, dv_;  // quadrature points, the first count_ in use
  std::size_t count_ = 0;                      // none but from a fan to flush()
  std::vector<double> fan_w_, fan_u_, fan_v_, fan_x_, fan_y_, fan_det_;  // of reference_fan
  std::vector<Vec2> plane_;  // points whose places in a donor element are wanted
  std::vector<Lambda> start_;
  std::vector<InverseResult> inverse_;
  std::vector<double> powers_;
  std::vector<double> shifted_;
  std::vector<double> fitted_mass_;
  std::vector<double> scratch_;
  Factor factor_, reference_factor_;
  int reference_degree_ = -1;
};

}  // namespace bezel::detail
