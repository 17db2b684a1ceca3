#include <bit>
#include <cstddef>
#include <type_traits>

#include "bezel/numeric/lanes.hpp"
#include "bezel/transfer/straight_walk.hpp"

// Few targets, for the sake of those who build this.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bezel/transfer/straight_steps.cpp"
#include "hwy/foreach_target.h"
// clang-format off
#include "hwy/highway.h"
// clang-format on

#ifndef BEZEL_TRANSFER_STRAIGHT_STEPS
#define BEZEL_TRANSFER_STRAIGHT_STEPS
namespace bezel::detail {

/// Two edges cross plainly when the cross product of their directions is at least this fraction of
/// what their lengths allow: parameters are then good to 1e-11, a hundredth of contact_isolation.
constexpr double least_sine = 1e-4;

/// Eight walks side by side.
struct alignas(64) WalkLanes {
  using Numbers = double[lanes];
  Numbers ax, ay, dx, dy, right_x, right_y, left_x, left_y, beside_right, beside_left;
  Numbers r, gap_squared, last_gap_squared;
  std::int64_t place[lanes];
  std::int32_t walk[lanes], first_step[lanes];
};

constexpr std::size_t groups = static_cast<std::size_t>(straight_stride) / lanes;
static_assert(groups * lanes == static_cast<std::size_t>(straight_stride));
static_assert(sizeof(WalkStep) == 4 * sizeof(double) && std::is_standard_layout_v<WalkStep>);
static_assert(offsetof(WalkStep, donor) == 16 && offsetof(WalkStep, donor_edge) == 20);
static_assert(sizeof(SoughtPoint) == 32 && offsetof(SoughtPoint, element) == 24);
static_assert(sizeof(SideEdge) == 8 && offsetof(SideEdge, reversed) == 4);
static_assert(sizeof(StraightElement) == 64 && offsetof(StraightElement, corner) == 0);
// Eight bytes are read.
static_assert(offsetof(StraightElement, beyond) == 48 &&
              std::endian::native == std::endian::little);

}  // namespace bezel::detail
#endif

HWY_BEFORE_NAMESPACE();
namespace bezel::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Bit l for lane l.
struct StepResult {
  unsigned plain = 0, ended = 0;
};

/// A step of each lane, for as many as fit a register: `at` is the first.
template <class D>
HWY_INLINE StepResult take_steps(D d, const StraightElement* elements,
                                 const std::array<SideEdge, 3>* edges, WalkLanes& w, std::size_t at,
                                 WalkStep* out) {
  const hn::RebindToSigned<D> di;
  using Ints = hn::Vec<decltype(di)>;
  const auto load = [&](const double* from) HWY_ATTR { return hn::Load(d, from + at); };
  const auto cross = [](const auto& ux, const auto& uy, const auto& vx, const auto& vy)
                         HWY_ATTR { return hn::Sub(hn::Mul(ux, vy), hn::Mul(uy, vx)); };
  const auto size_of = [](const auto& x, const auto& y)
                           HWY_ATTR { return hn::Add(hn::Abs(x), hn::Abs(y)); };
  const auto one = hn::Set(di, 1), three = hn::Set(di, 3);
  const auto ax = load(w.ax), ay = load(w.ay), dx = load(w.dx), dy = load(w.dy);
  auto right_x = load(w.right_x), right_y = load(w.right_y);
  auto left_x = load(w.left_x), left_y = load(w.left_y);
  auto beside_right = load(w.beside_right), beside_left = load(w.beside_left);
  const auto place = hn::Load(di, w.place + at);
  const auto donor = hn::ShiftRight<2>(place), side = hn::And(place, three);

  const auto* const integers = reinterpret_cast<const std::int64_t*>(elements);
  // Beyond the side, in the lower half.
  const auto found = hn::GatherOffset(
      di, integers,
      hn::Add(hn::Add(hn::ShiftLeft<6>(donor), hn::ShiftLeft<2>(side)), hn::Set(di, 48)));
  const auto beyond = hn::ShiftRight<32>(hn::ShiftLeft<32>(found));
  const auto threefold = hn::Add(hn::Add(donor, donor), donor);
  const auto edge = hn::GatherOffset(di, reinterpret_cast<const std::int64_t*>(edges),
                                     hn::ShiftLeft<3>(hn::Add(threefold, side)));
  const auto reversed = hn::And(hn::ShiftRight<32>(edge), one);

  const auto ex = hn::Sub(left_x, right_x), ey = hn::Sub(left_y, right_y);
  const auto from_x = hn::Sub(ax, right_x), from_y = hn::Sub(ay, right_y);
  const auto start = cross(ex, ey, from_x, from_y);
  const auto determinant = hn::Sub(beside_left, beside_right);  // cross(d, e)
  const auto inverse = hn::Div(hn::Set(d, 1.0), determinant);
  const auto r = hn::Mul(start, inverse);
  const auto along = hn::Mul(hn::Neg(beside_right), inverse);
  const auto is_reversed = hn::RebindMask(d, hn::Eq(reversed, one));
  const auto s = hn::IfThenElse(is_reversed, hn::Mul(hn::Abs(beside_left), inverse),
                                hn::Mul(hn::Abs(beside_right), inverse));
  const auto length = size_of(ex, ey);
  const auto apart_x = hn::Sub(hn::Add(from_x, hn::Mul(r, dx)), hn::Mul(along, ex));
  const auto apart_y = hn::Sub(hn::Add(from_y, hn::Mul(r, dy)), hn::Mul(along, ey));
  hn::StoreInterleaved4(r, s, hn::BitCast(d, hn::Or(donor, hn::ShiftLeft<32>(edge))),
                        hn::BitCast(d, reversed), d, reinterpret_cast<double*>(out + at));

  const auto last_gap = load(w.last_gap_squared);
  hn::Store(hn::Max(load(w.gap_squared), last_gap), d, w.gap_squared + at);
  hn::Store(hn::Add(hn::Mul(apart_x, apart_x), hn::Mul(apart_y, apart_y)), d,
            w.last_gap_squared + at);
  const auto ended = hn::Gt(start, determinant);
  const auto near = hn::Set(d, contact_isolation), far = hn::Set(d, 1.0 - contact_isolation);
  const auto sine =
      hn::Mul(hn::Mul(hn::Set(d, least_sine), length), hn::Add(length, size_of(dx, dy)));
  auto plain = hn::And(hn::And(hn::Gt(determinant, sine), hn::Gt(r, near)),
                       hn::And(hn::Lt(r, far), hn::Gt(s, near)));
  plain = hn::And(plain, hn::And(hn::Lt(s, far), hn::Ge(hn::Sub(r, load(w.r)), near)));
  const auto is_beyond = hn::Gt(beyond, hn::Set(di, -1));
  plain = hn::AndNot(ended, hn::And(plain, hn::RebindMask(d, is_beyond)));
  hn::Store(r, d, w.r + at);

  // The side just crossed runs the other way beyond: from the left of the line to the right. The
  // corner opposite of it lies on one side of the line, and the line leaves between that and the
  // end of this side on the other.
  const auto next = hn::IfThenElse(is_beyond, beyond, hn::ShiftLeft<2>(donor));
  const auto behind = hn::And(next, three), to = hn::ShiftRight<2>(next);
  const auto after = [&](const Ints& corner) HWY_ATTR {
    const auto plus = hn::Add(corner, one);
    return hn::IfThenZeroElse(hn::Eq(plus, three), plus);
  };
  const auto after_behind = after(behind), opposite = after(after_behind);
  const auto corner = hn::Add(hn::ShiftLeft<6>(to), hn::ShiftLeft<4>(opposite));
  const auto* const numbers = reinterpret_cast<const double*>(elements);
  const auto x = hn::GatherOffset(d, numbers, corner), y = hn::GatherOffset(d, numbers + 1, corner);
  const auto third = cross(dx, dy, hn::Sub(x, ax), hn::Sub(y, ay));
  const auto is_left = hn::Ge(third, hn::Zero(d));
  hn::Store(hn::IfThenElse(is_left, x, left_x), d, w.left_x + at);
  hn::Store(hn::IfThenElse(is_left, y, left_y), d, w.left_y + at);
  hn::Store(hn::IfThenElse(is_left, third, beside_left), d, w.beside_left + at);
  hn::Store(hn::IfThenElse(is_left, right_x, x), d, w.right_x + at);
  hn::Store(hn::IfThenElse(is_left, right_y, y), d, w.right_y + at);
  hn::Store(hn::IfThenElse(is_left, beside_right, third), d, w.beside_right + at);
  const auto next_side = hn::IfThenElse(hn::RebindMask(di, is_left), after_behind, opposite);
  hn::Store(hn::Or(hn::ShiftLeft<2>(to), next_side), di, w.place + at);

  std::uint8_t bits[8] = {};
  StepResult result;
  hn::StoreMaskBits(d, plain, bits);
  result.plain = static_cast<unsigned>(bits[0]) << at;
  hn::StoreMaskBits(d, ended, bits);
  result.ended = static_cast<unsigned>(bits[0]) << at;
  return result;
}

/// So many parts of the points are sought at a time, each one point after another: from one to the
/// next it is not far.
constexpr std::size_t seekers = 2 * lanes;
struct alignas(64) Seekers {
  std::int64_t point[seekers], last[seekers], at[seekers];
  std::int64_t steps[seekers];  // for this point
};

/// A step of each of as many seekers as fit a register; `from` is the first. Whether all are done.
template <class D>
HWY_INLINE bool seek(D d, const StraightElement* elements, SoughtPoint* points, Seekers& all,
                     std::size_t from, std::int64_t longest) {
  const hn::RebindToSigned<D> di;
  const auto* const corners = reinterpret_cast<const double*>(elements);
  const auto* const coordinates = reinterpret_cast<const double*>(points);
  const auto at = hn::Load(di, all.at + from), i = hn::Load(di, all.point + from);
  const auto point = hn::ShiftLeft<5>(i), element = hn::ShiftLeft<6>(at);
  const auto x = hn::GatherOffset(d, coordinates, point);
  const auto y = hn::GatherOffset(d, coordinates + 1, point);
  hn::Vec<D> cx[3], cy[3], l[3];
  for (std::size_t k = 0; k < 3; ++k) {
    cx[k] = hn::GatherOffset(d, corners + 2 * k, element);
    cy[k] = hn::GatherOffset(d, corners + 2 * k + 1, element);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    l[k] = hn::Sub(hn::Mul(hn::Sub(cx[next], cx[k]), hn::Sub(y, cy[k])),
                   hn::Mul(hn::Sub(cy[next], cy[k]), hn::Sub(x, cx[k])));
  }
  const auto first = hn::Min(l[0], l[1]), smallest = hn::Min(first, l[2]);
  const auto sum = hn::Add(hn::Add(l[0], l[1]), l[2]);
  const auto clear = hn::Gt(smallest, hn::Mul(hn::Set(d, clear_of_edges), sum));
  const auto one = hn::Set(di, 1);
  const auto side = hn::IfThenElse(hn::RebindMask(di, hn::Lt(l[2], first)), hn::Set(di, 2),
                                   hn::IfThenElseZero(hn::RebindMask(di, hn::Lt(l[1], l[0])), one));
  const auto beyond = hn::ShiftRight<34>(hn::ShiftLeft<32>(
      hn::GatherOffset(di, reinterpret_cast<const std::int64_t*>(elements),
                       hn::Add(hn::Add(element, hn::ShiftLeft<2>(side)), hn::Set(di, 48)))));
  // A walk may go in circles; one that is settled stays so.
  const auto steps = hn::Load(di, all.steps + from), last = hn::Load(di, all.last + from);
  const auto lost = hn::Or(hn::Gt(hn::Zero(di), beyond), hn::Gt(steps, hn::Set(di, longest)));
  const auto settled = hn::Or(hn::RebindMask(di, hn::Ge(smallest, hn::Zero(d))), lost);
  const auto goes_on = hn::And(settled, hn::Lt(i, last));
  hn::Store(hn::IfThenZeroElse(goes_on, hn::Add(steps, one)), di, all.steps + from);
  // What is found on the way is overwritten.
  hn::ScatterOffset(hn::IfThenElse(hn::RebindMask(di, clear), at, hn::Set(di, -1)), di,
                    reinterpret_cast<std::int64_t*>(points) + 3, point);
  hn::Store(hn::Add(i, hn::IfThenElseZero(goes_on, one)), di, all.point + from);
  hn::Store(hn::IfThenElse(settled, at, beyond), di, all.at + from);
  return hn::AllTrue(di, hn::And(settled, hn::Eq(i, last)));
}

std::int32_t locate_target(std::span<const StraightElement> elements, SoughtPoint* points,
                           std::size_t count, std::int32_t start) {
  const hn::CappedTag<double, lanes> d;
  Seekers all;
  for (std::size_t l = 0; l < seekers; ++l) {
    const std::size_t begin = l * count / seekers, end = (l + 1) * count / seekers;
    all.point[l] = static_cast<std::int64_t>(begin);
    all.last[l] = static_cast<std::int64_t>(end > begin ? end - 1 : begin);
    all.at[l] = start;
    all.steps[l] = 0;
  }
  const auto longest = static_cast<std::int64_t>(64 + elements.size() / 64);
  for (bool done = false; !done;) {
    done = true;
    for (std::size_t from = 0; from < seekers; from += hn::Lanes(d))
      done &= seek(d, elements.data(), points, all, from, longest);
  }
  return static_cast<std::int32_t>(all.at[seekers - 1]);
}

void begin(const StraightWalk& walk, WalkLanes& w, std::size_t l) {
  w.ax[l] = walk.a.x();
  w.ay[l] = walk.a.y();
  w.dx[l] = walk.d.x();
  w.dy[l] = walk.d.y();
  w.right_x[l] = walk.right.x();
  w.right_y[l] = walk.right.y();
  w.left_x[l] = walk.left.x();
  w.left_y[l] = walk.left.y();
  w.beside_right[l] = walk.beside_right;
  w.beside_left[l] = walk.beside_left;
  w.r[l] = w.gap_squared[l] = w.last_gap_squared[l] = 0.0;
  w.place[l] = walk.place;
}

void walk_target(const StraightElement* elements, const std::array<SideEdge, 3>* edges,
                 std::span<StraightWalk> walks, Pile<WalkStep>& steps) {
  const hn::CappedTag<double, lanes> d;
  WalkLanes all[groups] = {};
  unsigned going[groups] = {};  // bit l: lane l
  std::size_t next = 0, left = walks.size();
  // Lanes take the next walk as soon as theirs is done.
  const auto take_next = [&](std::size_t group, std::size_t lane, std::size_t step) HWY_ATTR {
    if (next == walks.size()) return;
    WalkLanes& w = all[group];
    begin(walks[next], w, lane);
    w.walk[lane] = static_cast<std::int32_t>(next++);
    w.first_step[lane] = static_cast<std::int32_t>(step + group * lanes + lane);
    going[group] |= 1U << lane;
  };
  for (std::size_t lane = 0; lane < lanes; ++lane)
    for (std::size_t group = 0; group < groups; ++group) take_next(group, lane, steps.size());
  while (left > 0) {
    constexpr auto stride = static_cast<std::size_t>(straight_stride);
    WalkStep* const out = steps.room(stride);
    const std::size_t round = steps.size();
    for (std::size_t group = 0; group < groups; ++group) {
      if (going[group] == 0) continue;
      WalkLanes& w = all[group];
      StepResult result;
      for (std::size_t at = 0; at < lanes; at += hn::Lanes(d)) {
        const StepResult part = take_steps(d, elements, edges, w, at, out + group * lanes);
        result.plain |= part.plain;
        result.ended |= part.ended;
      }
      unsigned done = going[group] & ~result.plain;
      going[group] &= result.plain;
      for (; done != 0; done &= done - 1) {
        const auto l = static_cast<std::size_t>(std::countr_zero(done));
        StraightWalk& walk = walks[static_cast<std::size_t>(w.walk[l])];
        const auto last = static_cast<std::int32_t>(round + group * lanes + l);
        walk.first_step = w.first_step[l];
        walk.steps = (last - walk.first_step) / straight_stride + 1;
        walk.gap_squared = w.gap_squared[l];
        walk.ended = (result.ended >> l & 1U) != 0;
        --left;
        take_next(group, l, round + stride);
      }
    }
    steps.resize(round + stride);
  }
}

}  // namespace bezel::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bezel::detail {

HWY_EXPORT(walk_target);
HWY_EXPORT(locate_target);

void walk_straight(std::span<const StraightElement> elements,
                   std::span<const std::array<SideEdge, 3>> edges, std::span<StraightWalk> walks,
                   Pile<WalkStep>& steps) {
  HWY_DYNAMIC_DISPATCH(walk_target)(elements.data(), edges.data(), walks, steps);
}

std::int32_t locate_straight(std::span<const StraightElement> elements,
                             std::span<SoughtPoint> points, std::int32_t start) {
  if (points.empty()) return start;
  return HWY_DYNAMIC_DISPATCH(locate_target)(elements, points.data(), points.size(), start);
}

}  // namespace bezel::detail
#endif
