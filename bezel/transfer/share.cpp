#include "bezel/transfer/share.hpp"

#include <algorithm>
#include <ctime>
#include <memory>
#include <utility>

namespace bezel::detail {
namespace {

std::size_t place(std::int32_t e) {
  return static_cast<std::size_t>(e);
}

/// Where a number is in an ascending list that holds it.
std::int32_t place_in(std::span<const std::int32_t> ascending, std::int32_t number) {
  return static_cast<std::int32_t>(std::lower_bound(ascending.begin(), ascending.end(), number) -
                                   ascending.begin());
}

void write_mesh(const TriangleMesh& mesh, std::span<const std::int32_t> elements,
                MessageWriter& out) {
  std::vector<std::int32_t> connectivity;
  for (const std::int32_t e : elements) {
    for (const NodeId n : mesh.nodes(ElementId(e))) connectivity.push_back(n.value);
  }
  std::vector<std::int32_t> nodes = connectivity;
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  for (std::int32_t& n : connectivity) n = place_in(nodes, n);
  std::vector<Vec2> control;
  for (const std::int32_t n : nodes) control.push_back(mesh.control(NodeId(n)));
  out.value(mesh.degree());
  out.list(control);
  out.list(connectivity);
  out.list(elements);
}

struct MeshPart {
  std::shared_ptr<const TriangleMesh> mesh;
  std::vector<std::int32_t> numbers;
};

MeshPart read_mesh(MessageReader& in) {
  const int degree = in.value<int>();
  std::vector<Vec2> control = in.list<Vec2>();
  std::vector<NodeId> nodes;
  for (const std::int32_t n : in.list<std::int32_t>()) nodes.emplace_back(n);
  MeshPart part;
  part.mesh = std::make_shared<const TriangleMesh>(degree, std::move(control), std::move(nodes));
  part.numbers = in.list<std::int32_t>();
  return part;
}

void write_group(const Share& share, const Group& g, MessageWriter& out) {
  const Space& donor = *g.donor_space;
  const auto nc = static_cast<std::size_t>(g.components);
  std::vector<int> degrees;
  std::vector<Frame> frames;
  std::vector<double> scaled;
  std::vector<double> mass;
  for (const std::int32_t d : share.donors) {
    degrees.push_back(donor.degree(ElementId(d)));
    if (donor.basis() == Basis::physical) frames.push_back(donor.frame(ElementId(d)));
    const auto own = g.donor_scaled(d);
    scaled.insert(scaled.end(), own.begin(), own.end());
    const double* own_mass = g.donor_mass.data() + place(d) * nc;
    mass.insert(mass.end(), own_mass, own_mass + nc);
  }
  out.value(g.components);
  out.value(g.donor_degree);
  out.value(donor.basis());
  out.list(degrees);
  out.list(frames);
  out.value(g.target_space->basis());
  out.value(g.target_space->uniform_degree());
  out.list(scaled);
  out.list(mass);
}

Group read_group(const OverlayMesh& donor, const OverlayMesh& target, MessageReader& in,
                 int threads) {
  const int components = in.value<int>();
  const auto donor_degree = in.value<DonorDegree>();
  const auto basis = in.value<Basis>();
  std::vector<int> degrees = in.list<int>();
  std::vector<Frame> frames = in.list<Frame>();
  const auto target_basis = in.value<Basis>();
  const int target_degree = in.value<int>();
  auto donor_space = basis == Basis::physical
                         ? Space::discontinuous(donor.mesh, std::move(degrees), std::move(frames))
                         : Space::discontinuous(donor.mesh, std::move(degrees), basis);
  auto target_space = Space::discontinuous(target.mesh, target_degree, target_basis);
  const std::vector<double> scaled = in.list<double>();
  std::vector<double> mass = in.list<double>();
  return Group(donor, target, std::move(donor_space), std::move(target_space), components,
               donor_degree, scaled, std::move(mass), threads);
}

void write_chunk(const ChunkResult& chunk, const OverlayMesh& donor, const OverlayMesh& target,
                 MessageWriter& out) {
  const auto numbers = [&](const OverlayMesh& mesh, std::span<const std::int32_t> elements) {
    std::vector<std::int32_t> of_whole;
    for (const std::int32_t e : elements) of_whole.push_back(mesh.number_of(e));
    out.list(of_whole);
  };
  numbers(donor, chunk.given.donor);
  numbers(target, chunk.given.target);
  out.list(chunk.given.area);
  out.list(chunk.given.massed);
  out.list(chunk.given.mass);
  out.value(chunk.counts);
  out.list(chunk.made);
  numbers(target, chunk.element_made.element);
  out.list(chunk.element_made.mass);
  std::vector<std::int32_t> uncovered;
  std::vector<double> uncovered_area;
  for (const auto& [element, area] : chunk.uncovered) {
    uncovered.push_back(element.value);
    uncovered_area.push_back(area);
  }
  numbers(target, uncovered);
  out.list(uncovered_area);
  out.value(chunk.extension);
  for (const double x : {chunk.uncovered_area, chunk.max_partition_residual, chunk.max_joint_gap,
                         chunk.max_mass_defect, chunk.overlay, chunk.integrate, chunk.solve})
    out.value(x);
  out.value(chunk.inconsistent < 0 ? chunk.inconsistent : target.number_of(chunk.inconsistent));
  out.value(chunk.inconsistent_count);
}

ChunkResult read_chunk(MessageReader& in) {
  ChunkResult chunk;
  chunk.given.donor = in.list<std::int32_t>();
  chunk.given.target = in.list<std::int32_t>();
  chunk.given.area = in.list<double>();
  chunk.given.massed = in.list<std::int32_t>();
  chunk.given.mass = in.list<double>();
  chunk.counts = in.value<OverlayCounts>();
  chunk.made = in.list<double>();
  chunk.element_made.element = in.list<std::int32_t>();
  chunk.element_made.mass = in.list<double>();
  const auto uncovered = in.list<std::int32_t>();
  const auto uncovered_area = in.list<double>();
  for (std::size_t i = 0; i < uncovered.size(); ++i)
    chunk.uncovered.emplace_back(ElementId(uncovered[i]), uncovered_area.at(i));
  chunk.extension = in.value<ExtensionReport>();
  for (double* x : {&chunk.uncovered_area, &chunk.max_partition_residual, &chunk.max_joint_gap,
                    &chunk.max_mass_defect, &chunk.overlay, &chunk.integrate, &chunk.solve})
    *x = in.value<double>();
  chunk.inconsistent = in.value<std::int32_t>();
  chunk.inconsistent_count = in.value<std::int64_t>();
  return chunk;
}

double clock_seconds(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

Stopwatch::Stopwatch()
    : wall_start_(clock_seconds(CLOCK_MONOTONIC)),
      cpu_start_(clock_seconds(CLOCK_PROCESS_CPUTIME_ID)) {}
double Stopwatch::seconds() const {
  return clock_seconds(CLOCK_MONOTONIC) - wall_start_;
}
double Stopwatch::cpu_seconds() const {
  return clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu_start_;
}

void write_share(const Share& share, const OverlayMesh& donor, const OverlayMesh& target,
                 const FrontSearch& search, std::span<const Group> groups,
                 const TransferOptions& options, MessageWriter& out) {
  out.value(options.uncovered);
  out.value(options.conserve);
  write_mesh(*donor.mesh, share.donors, out);
  out.value(search.connected());
  write_mesh(*target.mesh, share.targets, out);
  std::vector<std::int32_t> own;
  for (const std::int32_t t : share.own) own.push_back(place_in(share.targets, t));
  out.list(own);
  out.value(static_cast<std::uint64_t>(groups.size()));
  for (const Group& g : groups) write_group(share, g, out);
}

ShareReport work_on(MessageReader& in, int threads, MessageWriter& out) {
  const Stopwatch watch;
  TransferOptions options;
  options.threads = threads;
  options.uncovered = in.value<Uncovered>();
  options.conserve = in.value<Conserve>();
  MeshPart donor_part = read_mesh(in);
  const bool connected = in.value<bool>();
  MeshPart target_part = read_mesh(in);
  const std::vector<std::int32_t> own = in.list<std::int32_t>();
  ShareReport work;
  work.targets = static_cast<std::int64_t>(own.size());
  work.donors = static_cast<std::int64_t>(donor_part.numbers.size());
  const auto group_count = in.value<std::uint64_t>();
  std::vector<Group> groups;
  OverlayMesh donor(std::move(donor_part.mesh), "donor", threads);
  donor.numbers = std::move(donor_part.numbers);
  OverlayMesh target(std::move(target_part.mesh), "target", threads);
  target.numbers = std::move(target_part.numbers);
  for (std::uint64_t i = 0; i < group_count; ++i)
    groups.push_back(read_group(donor, target, in, threads));
  const FrontSearch search(donor, connected);
  const std::vector<ChunkResult> chunks =
      sweep_elements(donor, target, search, groups, own, options, {});
  for (const ChunkResult& chunk : chunks) {
    work.pairs += chunk.counts.pairs;
    write_chunk(chunk, donor, target, out);
  }
  for (Group& g : groups) {
    std::vector<double> coefficients;
    for (const std::int32_t t : own) {
      const auto of_element = g.target_out(t);
      coefficients.insert(coefficients.end(), of_element.begin(), of_element.end());
    }
    out.list(coefficients);
  }
  work.seconds = watch.seconds();
  work.cpu_seconds = watch.cpu_seconds();
  return work;
}

void read_results(const Share& share, MessageReader& in, std::span<Group> groups,
                  std::span<ChunkResult> chunks) {
  for (std::size_t c = 0; c < share.chunk_count; ++c)
    chunks[share.first_chunk + c] = read_chunk(in);
  for (Group& g : groups) {
    const std::vector<double> coefficients = in.list<double>();
    auto from = coefficients.begin();
    for (const std::int32_t t : share.own) {
      const auto to = g.target_out(t);
      if (coefficients.end() - from < static_cast<std::ptrdiff_t>(to.size()))
        throw InternalError("a share's coefficients are too few");
      std::copy_n(from, to.size(), to.begin());
      from += static_cast<std::ptrdiff_t>(to.size());
    }
  }
}

}  // namespace bezel::detail
