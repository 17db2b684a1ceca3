#include "bezel/fit/curve_ladder.hpp"

namespace bezel::curve_search {
namespace {

// Below this fraction of the length a distance is rounding error.
constexpr double floor_of_length = 4e-15;
// Nodes of any degree on the way as near to the curve as this are taken when their speed is more
// even: crowding buys the last digit with a slow, uneven interpolant, and maps of regions by the
// curve suffer.
constexpr double nearly_floor = 4.2e-14;
// A degree whose distance falls by this factor needs no closer look; the last degree, by the
// second.
constexpr double enough = 0.3, enough_at_last = 0.15;
// A distance that falls by this factor with each degree, below this fraction of the length, is that
// of a curve that is resolved: its good nodes follow from those of the degree before.
constexpr double steady = 0.2, resolved = 1e-3;
// From the nodes of the last degree: least distance falls slowly in flat valleys.
constexpr int last_polish = 160;
constexpr double last_gain = 1e-4;
// By which part of the gaps beside them nodes leave a saddle: enough to find the way down above
// rounding, too little to end in another valley (1e-2 does).
constexpr double saddle_push = 1e-4;
// Points this fraction of the length away from the curve are on it.
constexpr double rounding = 1e-15;
// Below this fraction of the length, degrees that bring no gain are left out.
constexpr double nearly_exact = 1e-12;

// Whether the distance is below a fraction of the length.
template <int dim>
bool within(const Problem<dim>& problem, const Score<dim>& score, double fraction) {
  return score.valid && score.d2 < fraction * problem.length;
}

// Whether to take nodes that are nearly exact instead of others.
template <int dim>
bool more_even(const Problem<dim>& problem, const Found<dim>& plain, const Found<dim>& other) {
  return within(problem, plain.score, nearly_floor) &&
         plain.score.min_speed > 1.1 * other.score.min_speed;
}

// Nodes instead of the best, and of the best root if they are one, where they are more even.
template <int dim>
void prefer_even(const Problem<dim>& problem, const Nodes<dim>& nodes, Found<dim>& best,
                 Found<dim>& root) {
  constexpr double is_root = 1e-10;
  Found<dim> found{nodes, measure(problem, nodes), CurveKind::orthogonal_distance};
  const bool solved = nodes.ordered() && tangent_residual(problem, nodes) <= is_root;
  if (solved) found.kind = CurveKind::equal_tangent;
  if (more_even(problem, found, best)) best = found;
  if (solved && more_even(problem, found, root)) root = found;
}

// Nodes of degree `next.n` from those of a lower degree: feet of the points of its interpolant.
//
// @param rows    row j: the lower degree's Lagrange polynomials at xi_j
// @param exact   iterate the feet (else one step each)
// @return        largest distance of such a point to its foot
template <int dim>
double project(const Problem<dim>& problem, const Nodes<dim>& lower, const double* rows, bool exact,
               Nodes<dim>& next) {
  const auto xi = problem.tables.rung(next.n).basis.nodes();
  const auto below = problem.tables.rung(lower.n).basis.nodes();
  std::array<double, max_nodes> linear{};
  double largest = 0.0;
  bool ordered = true;
  problem.set_ends(next);
  for (std::size_t j = 1, k = 0; j < std::size_t(next.n); ++j) {
    const double* row = rows + j * std::size_t(lower.n + 1);
    while (k + 2 < below.size() && xi[j] > below[k + 1]) ++k;
    linear[j] =
        lower.t[k] + (lower.t[k + 1] - lower.t[k]) * (xi[j] - below[k]) / (below[k + 1] - below[k]);
    double guess = 0.0;
    for (int i = 0; i <= lower.n; ++i) guess += row[i] * lower.t[std::size_t(i)];
    if (!(guess > lower.t[k] && guess < lower.t[k + 1])) guess = linear[j];
    const Vec<dim> q = combine(row, lower);
    if (exact) {
      const Foot<dim> f = foot(problem.curve, q, guess);
      largest = std::max(largest, norm(f.e));
      next.t[j] = f.s;
    } else {
      const CurveJet<dim> jet = problem.curve(guess);
      const Vec<dim> e = q - jet.x;
      next.t[j] = guess + foot_step(jet, e, guess);
      const Vec<dim> across = e - (dot(e, jet.d1) / dot(jet.d1, jet.d1)) * jet.d1;
      largest = std::max(largest, norm(across));
    }
    ordered = ordered && next.t[j] > next.t[j - 1];
  }
  ordered = ordered && next.t[std::size_t(next.n) - 1] < 1.0;
  for (int j = 1; j < next.n; ++j)
    next.place(problem.curve, j, ordered ? next.t[std::size_t(j)] : linear[std::size_t(j)]);
  return ordered ? largest : HUGE_VAL;
}

// The interpolant of a much lower degree, exact to rounding, with the nodes of this one.
template <int dim>
Nodes<dim> lift(const Problem<dim>& problem, const Nodes<dim>& lower, int degree) {
  const CurveRung& from = problem.tables.rung(lower.n);
  const auto xi = problem.tables.rung(degree).basis.nodes();
  const std::size_t width = std::size_t(lower.n) + 1;
  std::array<double, max_nodes * max_nodes> rows;
  for (std::size_t j = 0; j < xi.size(); ++j)
    from.basis.values(xi[j], std::span(rows).subspan(j * width, width));
  Nodes<dim> next;
  next.n = degree;
  project(problem, lower, rows.data(), true, next);
  return next;
}

// Nodes after a change of parameter that gives a part `density` of its speed at xi = c, so that the
// nodes crowd there: phi(c + h u) = c + h (b u + (1 - b) u^3) on both sides, h = +-1 - c.
template <int dim>
Nodes<dim> crowded(const Problem<dim>& problem, const Nodes<dim>& nodes, double c, double density) {
  const CurveRung& rung = problem.tables.rung(nodes.n);
  const auto xi = rung.basis.nodes();
  const std::size_t width = std::size_t(nodes.n) + 1;
  std::array<double, max_nodes * max_nodes> rows;
  for (std::size_t j = 0; j < width; ++j) {
    const double h = xi[j] < c ? -1.0 - c : 1.0 - c, u = (xi[j] - c) / h;
    rung.basis.values(c + h * (density * u + (1.0 - density) * u * u * u),
                      std::span(rows).subspan(j * width, width));
  }
  Nodes<dim> next;
  next.n = nodes.n;
  project(problem, nodes, rows.data(), true, next);
  return next;
}

// Nodes spread by a density of |curvature|^(1/3) + a tenth of its mean, per arc length.
template <int dim>
Nodes<dim> curvature_nodes(const Problem<dim>& problem, int degree) {
  constexpr int panels = 200;
  std::array<double, panels> speed, weight;
  double mean = 0.0;
  for (std::size_t i = 0; i < panels; ++i) {
    const CurveJet<dim> jet = problem.curve(-1.0 + (2.0 * double(i) + 1.0) / panels);
    const double v2 = dot(jet.d1, jet.d1);
    const Vec<dim> across = jet.d2 - (dot(jet.d1, jet.d2) / v2) * jet.d1;
    speed[i] = std::sqrt(v2);
    weight[i] = std::cbrt(norm(across) / v2);
    mean += weight[i] * speed[i];
  }
  mean *= 2.0 / panels / problem.length;
  std::array<double, panels + 1> sum{};
  for (std::size_t i = 0; i < panels; ++i)
    sum[i + 1] = sum[i] + speed[i] * (mean > 0.0 ? weight[i] + 0.1 * mean : 1.0);
  const auto xi = problem.tables.rung(degree).basis.nodes();
  Nodes<dim> nodes;
  nodes.n = degree;
  problem.set_ends(nodes);
  for (std::size_t j = 1, i = 0; j < std::size_t(degree); ++j) {
    const double target = sum.back() * 0.5 * (1.0 + xi[j]);
    while (i + 1 < panels && sum[i + 1] < target) ++i;
    const double part = (target - sum[i]) / (sum[i + 1] - sum[i]);
    nodes.place(problem.curve, int(j), -1.0 + 2.0 * (double(i) + part) / panels);
  }
  return nodes;
}

// One degree's search: keeps the best nodes and the best root.
template <int dim>
class Level {
 public:
  // Steps towards least distance, as long as they may become the best.
  void minimise(Nodes<dim>& nodes, Score<dim>& score, int iterations) {
    const bool rival = best.nodes.n == degree_ && best.score.valid;
    effort_.distance += minimise_distance(
        problem_, nodes, score,
        {.most = iterations, .rival = rival ? &best.nodes : nullptr, .rival_d2 = best.score.d2});
  }
  Level(const Problem<dim>& problem, int degree, Effort& effort)
      : problem_(problem), degree_(degree), effort_(effort) {}
  Found<dim> best, root;
  Found<dim> plain;  // the best of those offered before plain_over
  bool plain_over = false;

  Score<dim> offer(const Nodes<dim>& nodes, bool is_root) {
    const Score<dim> score = measure(problem_, nodes);
    keep(nodes, score, is_root);
    return score;
  }
  // Newton from a start.
  void newton(Nodes<dim> nodes, bool patient) {
    const NewtonResult r = solve_tangents(problem_, nodes, patient);
    effort_.newton += r.iterations;
    if (nodes.ordered()) offer(nodes, r.converged);
  }
  // Least distance from a start, then Newton from there.
  void descend(Nodes<dim> nodes) {
    Score<dim> score = measure(problem_, nodes);
    minimise(nodes, score, 15);
    keep(nodes, score, false);
    if (score.valid) newton(nodes, false);
  }
  // Least distance and Newton in turn. Newton leaves valleys in which the distance falls slowly,
  // also where it does not converge; a few steps of least distance then follow from there.
  void explore(Nodes<dim> nodes, int rounds) {
    Score<dim> score = measure(problem_, nodes);
    for (int round = 0; round < rounds; ++round) {
      minimise(nodes, score, round == 0 ? 8 : round == 1 ? 15 : 40);
      keep(nodes, score, false);
      if (!score.valid) return;
      Nodes<dim> aside = nodes;
      const NewtonResult r = solve_tangents(problem_, aside, round >= 2);
      effort_.newton += r.iterations;
      if (!aside.ordered()) continue;
      Score<dim> found = offer(aside, r.converged);
      if (!found.valid) continue;
      minimise(aside, found, 8);
      keep(aside, found, false);
    }
  }
  // A few steps of least distance from nodes found.
  void polish(const Found<dim>& from, const DistanceSteps<dim>& steps) {
    if (!from.score.valid || at_floor()) return;
    Nodes<dim> nodes = from.nodes;
    Score<dim> score = from.score;
    effort_.distance += minimise_distance(problem_, nodes, score, steps);
    keep(nodes, score, false);
  }
  bool done(const Found<dim>& last, double factor) const {
    return at_floor() || fell(best, last, factor);
  }
  static bool fell(const Found<dim>& found, const Found<dim>& last, double factor) {
    return found.score.valid && last.score.valid && found.score.d2 < factor * last.score.d2;
  }
  bool at_floor() const { return within(problem_, best.score, floor_of_length); }

 private:
  void keep(const Nodes<dim>& nodes, const Score<dim>& score, bool is_root) {
    const Found<dim> found{nodes, score,
                           is_root ? CurveKind::equal_tangent : CurveKind::orthogonal_distance};
    if (better(score, best)) best = found;
    if (!plain_over && better(score, plain)) plain = found;
    if (is_root && !score.slow && better(score, root)) root = found;
  }
  bool better(const Score<dim>& score, const Found<dim>& than) const {
    if (than.nodes.n != degree_) return true;  // nothing yet
    if (score.valid != than.score.valid) return score.valid;
    if (!score.valid) return std::fabs(1.0 - score.length) < std::fabs(1.0 - than.score.length);
    return score.d2 < than.score.d2;
  }
  const Problem<dim>& problem_;
  int degree_;
  Effort& effort_;
};

// Nodes of degree n from those of a lower one.
template <int dim>
Nodes<dim> raised(const Problem<dim>& problem, const Nodes<dim>& lower, int n) {
  if (lower.n < n - 2) return lift(problem, lower, n);
  const CurveRung& rung = problem.tables.rung(n);
  Nodes<dim> next;
  next.n = n;
  project(problem, lower, (lower.n == n - 1 ? rung.from_last : rung.from_second).data(), true,
          next);
  return next;
}

// Starts that know nothing of distances: the two degrees before, arc length, curvature.
template <int dim>
void search_plain(const Problem<dim>& problem, Level<dim>& level, const Nodes<dim>& start,
                  const Found<dim>& before, const Found<dim>& last, double factor) {
  const int n = start.n;
  level.descend(start);
  const Nodes<dim> arc = arc_length_nodes(problem, n);
  level.offer(arc, false);
  level.newton(arc, false);
  level.descend(arc);
  if (before.nodes.n > 0 && !level.done(last, factor)) {
    level.newton(raised(problem, before.nodes, n), false);
  }
  if (!level.done(last, factor)) {
    level.descend(curvature_nodes(problem, n));
  }
}

// Nodes moved forwards and backwards in turn by a part of the gaps beside them.
template <int dim>
Found<dim> pushed(const Problem<dim>& problem, const Found<dim>& from, double part) {
  Found<dim> out = from;
  for (int j = 1; j < from.nodes.n; ++j) {
    const double* t = from.nodes.t.data() + j;
    const double step = j % 2 == 0 ? -part : part;
    out.nodes.place(problem.curve, j, t[0] + step * std::min(t[0] - t[-1], t[1] - t[0]));
  }
  out.score = measure(problem, out.nodes);
  return out;
}

// Never worse than the simple placements.
template <int dim>
void offer_simple(const Problem<dim>& problem, Level<dim>& level, int n) {
  level.offer(arc_length_nodes(problem, n), false);
  for (const CurveMethod method : {CurveMethod::chord, CurveMethod::standard}) {
    Nodes<dim> nodes;
    if (projected_nodes(problem, n, method, nodes) == CurveStatus::ok) level.offer(nodes, false);
  }
}
}  // namespace

template <int dim>
Quick<dim> quick_climb(const Problem<dim>& problem, int degree, Effort& effort) {
  Quick<dim> quick;
  // No degree is left out: there are many roots, and from the degree before the last Newton's
  // method mostly finds a worse one.
  Nodes<dim> lower = problem.chord();
  double largest = HUGE_VAL;
  for (int n = 2; n <= degree; ++n) {
    Nodes<dim> next;
    next.n = n;
    largest = project(problem, lower, problem.tables.rung(n).from_last.data(), false, next);
    const double part = largest / problem.length;
    if (part <= rounding && lower.n > 1) {
      lower = lift(problem, lower, degree);
      break;
    }
    // On the way an error that is small beside the next interpolant's distance does not matter.
    constexpr double root = 1e-12, loosest = 1e-2;
    const double converged = n < degree ? std::clamp(part * part, root, loosest) : root;
    const NewtonResult r = solve_tangents(problem, next, false, converged);
    effort.newton += r.iterations;
    if (!r.converged) return quick;
    quick.before = quick.last;
    quick.last = lower;
    lower = next;
  }
  const Score<dim> score = measure(problem, lower);
  quick.found = {lower, score, CurveKind::equal_tangent};
  quick.good = score.valid && score.d2 <= std::max(0.5 * largest * std::sqrt(problem.length),
                                                   floor_of_length * problem.length);
  return quick;
}

template <int dim>
bool converges(const Problem<dim>& problem, const Quick<dim>& quick) {
  if (!quick.good) return false;
  if (within(problem, quick.found.score, floor_of_length)) return true;
  if (!within(problem, quick.found.score, resolved) || quick.before.n < 1) return false;
  const Score<dim> last = measure(problem, quick.last), before = measure(problem, quick.before);
  const auto rate = [](double d, int n, double d_lower, int n_lower) {
    return std::pow(d / d_lower, 1.0 / (n - n_lower));
  };
  return rate(quick.found.score.d2, quick.found.nodes.n, last.d2, quick.last.n) < steady &&
         rate(last.d2, quick.last.n, before.d2, quick.before.n) < steady;
}

template <int dim>
void polish(const Problem<dim>& problem, Found<dim>& found, Effort& effort) {
  Level<dim> level(problem, found.nodes.n, effort);
  level.offer(found.nodes, true);
  if (!level.at_floor())
    level.polish(level.best, {.most = last_polish, .least_gain = last_gain});
  else if (!within(problem, level.best.score, rounding))
    level.offer(arc_length_nodes(problem, found.nodes.n), false);
  found = level.best;
}

template <int dim>
void climb(const Problem<dim>& problem, int degree, const Quick<dim>& quick, Found<dim>& best,
           Found<dim>& root, Effort& effort) {
  // Two chains: the best nodes of each degree, and the best without crowded starts. The first alone
  // loses its way: on curves of low regularity better nodes of one degree lead to worse ones of
  // the next.
  Found<dim> last{problem.chord(), {}, CurveKind::placed};
  last.score = measure(problem, last.nodes);
  best = root = last;
  Found<dim> plain = last, before, even;  // even: the most even of those nearly exact
  int idle = 0;                           // nearly exact degrees in a row that brought no gain
  for (int n = 2; n <= degree; ++n) {
    const bool final = n == degree;
    if (within(problem, last.score, floor_of_length)) {
      // Exact already: the same polynomial with more nodes is a root too, to rounding.
      const bool instead = more_even(problem, even, last);
      Level<dim> top(problem, degree, effort);
      const Nodes<dim> start = lift(problem, instead ? even.nodes : last.nodes, degree);
      top.offer(start, true);
      if (quick.good) top.offer(quick.found.nodes, true);
      if (instead) {
        top.newton(start, true);
        top.polish(top.best, {.most = 8});
      }
      // Digits below that, in which a placement by formula may be ahead.
      if (!within(problem, top.best.score, rounding))
        top.offer(arc_length_nodes(problem, degree), false);
      best = top.best;
      root = top.root;
      return;
    }
    Level<dim> level(problem, n, effort);
    if (final && quick.good) level.offer(quick.found.nodes, true);
    const double factor = final ? enough_at_last : enough;
    const Nodes<dim> start = raised(problem, plain.nodes, n);
    level.offer(start, false);
    level.newton(start, false);
    if (!level.done(plain, factor)) search_plain(problem, level, start, before, plain, factor);
    level.polish(level.plain, {.most = 8});
    level.plain_over = true;
    if (plain.score.d2 != last.score.d2) {
      const Nodes<dim> other = raised(problem, last.nodes, n);
      level.newton(other, false);
      if (!level.done(last, factor)) level.descend(other);
    }
    if (!level.done(last, factor) && level.best.score.valid) {
      const Found<dim> from = level.best;
      level.descend(crowded(problem, from.nodes, from.score.slow_xi, 0.5));
      level.descend(crowded(problem, from.nodes, from.score.far_xi, 0.5));
    }
    // Least distance ended somewhere in a valley: a root may be near that its start did not see.
    if (!level.done(last, factor) && level.best.score.valid) level.newton(level.best.nodes, true);
    // Where degrees bring no more gain and are left out, the last one before is searched instead.
    const bool jumped = last.nodes.n < n - 1;
    const bool nearly =
        level.best.score.valid && level.best.score.d2 < nearly_exact * problem.length;
    if ((final || nearly) && !jumped) {
      for (const double density : {0.8, 0.9}) {
        if (level.done(last, factor) || !level.best.score.valid) break;
        const Found<dim> from = level.best;
        level.explore(crowded(problem, from.nodes, from.score.slow_xi, density), nearly ? 4 : 2);
        level.explore(crowded(problem, from.nodes, from.score.far_xi, density), 2);
      }
    }
    if (final && !within(problem, level.best.score, rounding)) offer_simple(problem, level, n);
    const bool gained = level.done(last, enough);
    if (final) {
      const DistanceSteps<dim> steps{.most = last_polish, .least_gain = last_gain};
      const double stuck = 0.9 * level.best.score.d2;
      level.polish(level.best, steps);
      // From a saddle, where least distance stops at once, a small push of either sign leads on.
      if (!level.done(last, factor) && !within(problem, level.best.score, nearly_floor))
        for (const double part : {saddle_push, -saddle_push})
          if (level.best.score.d2 > stuck) level.polish(pushed(problem, level.best, part), steps);
    }
    if (!final && !gained) level.polish(level.best, {.most = 8});
    before = plain;
    plain = level.plain;
    last = level.best;
    for (const Found<dim>* found : {&plain, &last})
      if (more_even(problem, *found, even)) even = *found;
    if (final) {
      best = level.best;
      root = level.root;
      if (more_even(problem, even, best) || more_even(problem, even, root)) {
        // Lifted nodes are up to three times as far; a few steps bring them back, and are no more
        // than needed, since each makes them less even.
        Nodes<dim> nodes = lift(problem, even.nodes, n);
        Score<dim> score = measure(problem, nodes);
        for (int most = 2; most <= 8 && !within(problem, score, nearly_floor); most *= 2)
          effort.distance += minimise_distance(problem, nodes, score, {.most = most});
        prefer_even(problem, nodes, best, root);
        effort.newton += solve_tangents(problem, nodes, true).iterations;
        prefer_even(problem, nodes, best, root);
      }
    } else if (gained || last.score.d2 >= nearly_exact * problem.length) {
      idle = 0;
    } else if (++idle == 2) {
      plain = more_even(problem, even, last) ? even : last;
      n = degree - 1;
    }
  }
}

template Quick<2> quick_climb(const Problem<2>&, int, Effort&);
template Quick<3> quick_climb(const Problem<3>&, int, Effort&);
template bool converges(const Problem<2>&, const Quick<2>&);
template bool converges(const Problem<3>&, const Quick<3>&);
template void polish(const Problem<2>&, Found<2>&, Effort&);
template void polish(const Problem<3>&, Found<3>&, Effort&);
template void climb(const Problem<2>&, int, const Quick<2>&, Found<2>&, Found<2>&, Effort&);
template void climb(const Problem<3>&, int, const Quick<3>&, Found<3>&, Found<3>&, Effort&);

}  // namespace bezel::curve_search
