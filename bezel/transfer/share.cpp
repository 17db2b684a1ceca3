#include "bezel/transfer/share.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <memory>
#include <utility>

#include "bezel/field/element_kernel.hpp"
#include "bezel/field/integrals.hpp"

namespace bezel::detail {
namespace {

std::size_t place(std::int32_t e) {
  return static_cast<std::size_t>(e);
}

/// Notes the places of the numbers of a list.
void note_places(std::span<const std::int32_t> numbers, std::span<std::int32_t> places) {
  std::int32_t next = 0;
  for (const std::int32_t n : numbers) places[place(n)] = next++;
}
void forget_places(std::span<const std::int32_t> numbers, std::span<std::int32_t> places) {
  for (const std::int32_t n : numbers) places[place(n)] = -1;
}

/// @param places  of the nodes, all -1 before and after
void write_mesh(const TriangleMesh& mesh, std::span<const std::int32_t> elements,
                const AreaMap& map, std::span<std::int32_t> places, MessageWriter& out) {
  std::vector<std::int32_t> connectivity;
  std::vector<std::int32_t> nodes;
  for (const std::int32_t e : elements) {
    for (const NodeId n : mesh.nodes(ElementId(e))) {
      connectivity.push_back(n.value);
      if (places[n.index()] >= 0) continue;
      places[n.index()] = 0;
      nodes.push_back(n.value);
    }
  }
  std::sort(nodes.begin(), nodes.end());
  note_places(nodes, places);
  for (std::int32_t& n : connectivity) n = places[place(n)];
  forget_places(nodes, places);
  std::vector<Vec2> control, given;
  control.reserve(nodes.size());
  double largest = 0.0;
  for (const std::int32_t n : nodes) {
    const Vec2& p = mesh.control(NodeId(n));
    largest = std::max({largest, std::abs(p.x()), std::abs(p.y())});
    control.push_back(map(p));
    if (!map.identity) given.push_back(p);
  }
  out.value(mesh.degree());
  out.value(map.rounding(largest));
  out.list(control);
  out.list(given);
  out.list(connectivity);
  out.list(elements);
}

struct MeshPart {
  double rounding;
  std::vector<Vec2> given_control;
  std::shared_ptr<const TriangleMesh> mesh;
  std::vector<std::int32_t> numbers;
};

MeshPart read_mesh(MessageReader& in) {
  const int degree = in.value<int>();
  const auto rounding = in.value<double>();
  std::vector<Vec2> control = in.list<Vec2>();
  std::vector<Vec2> given_control = in.list<Vec2>();
  std::vector<NodeId> nodes;
  for (const std::int32_t n : in.list<std::int32_t>()) nodes.emplace_back(n);
  MeshPart part;
  part.given_control = std::move(given_control);
  part.rounding = rounding;
  part.mesh = std::make_shared<const TriangleMesh>(degree, std::move(control), std::move(nodes));
  part.numbers = in.list<std::int32_t>();
  return part;
}

/// The frames of a physical basis. Those of straight triangles that are their own frames up to the
/// rounding of coordinates are so in the other plane.
std::vector<Frame> frames_in(const AreaMap& map, const Space& space, const OverlayMesh& mesh,
                             std::span<const std::int32_t> elements) {
  std::vector<Frame> frames;
  if (space.basis() != Basis::physical) return frames;
  for (const std::int32_t e : elements) {
    const Frame& frame = space.frame(ElementId(e));
    std::array<Vec2, 3> corners = mesh.corners(e);
    if (map.identity) {
      frames.push_back(frame);
    } else if (mesh.degree == 1 && space.is_own_frame(ElementId(e))) {
      std::transform(corners.begin(), corners.end(), corners.begin(), map);
      frames.push_back(affine_frame(corners));
    } else {
      frames.push_back(field_detail::moved(map, frame));
    }
  }
  return frames;
}

/// The frames of a physical basis as they are, where frames_in() moves them.
std::vector<Frame> given_frames(const AreaMap& map, const Space& space,
                                std::span<const std::int32_t> elements) {
  std::vector<Frame> frames;
  if (map.identity || space.basis() != Basis::physical) return frames;
  for (const std::int32_t e : elements) frames.push_back(space.frame(ElementId(e)));
  return frames;
}

void write_group(const Share& share, const Group& g, const OverlayMesh& donor_mesh,
                 const OverlayMesh& target_mesh, const AreaMap& map, MessageWriter& out) {
  const Space& donor = *g.donor_space;
  std::vector<int> degrees;
  for (const std::int32_t d : share.donors) degrees.push_back(donor.degree(ElementId(d)));
  out.value(g.of_basis());
  out.value(g.components);
  out.value(g.donor_degree);
  out.value(donor.basis());
  out.list(degrees);
  out.list(frames_in(map, donor, donor_mesh, share.donors));
  out.value(g.target_space->basis());
  out.list(map.identity ? std::vector<Frame>()
                        : frames_in(map, *g.target_space, target_mesh, share.targets));
  out.value(g.target_space->uniform_degree());
  out.list(given_frames(map, donor, share.donors));
  out.list(given_frames(map, *g.target_space, share.targets));
  if (g.of_basis()) return;
  const auto nc = static_cast<std::size_t>(g.components);
  std::vector<double> scaled;
  std::vector<double> mass;
  for (const std::int32_t d : share.donors) {
    const auto own = g.donor_scaled(d);
    scaled.insert(scaled.end(), own.data(), own.data() + own.size());
    const double* own_mass = g.donor_mass.data() + place(d) * nc;
    mass.insert(mass.end(), own_mass, own_mass + nc);
  }
  out.list(scaled);
  out.list(mass);
}

Group read_group(const OverlayMesh& donor, const OverlayMesh& target, int threads,
                 MessageReader& in) {
  const bool of_basis = in.value<bool>();
  const int components = in.value<int>();
  const auto donor_degree = in.value<DonorDegree>();
  const auto basis = in.value<Basis>();
  std::vector<int> degrees = in.list<int>();
  std::vector<Frame> frames = in.list<Frame>();
  const auto target_basis = in.value<Basis>();
  std::vector<Frame> target_frames = in.list<Frame>();
  const int target_degree = in.value<int>();
  auto donor_space = basis == Basis::physical
                         ? Space::discontinuous(donor.mesh, std::move(degrees), std::move(frames))
                         : Space::discontinuous(donor.mesh, std::move(degrees), basis);
  auto target_space =
      target_frames.empty()
          ? Space::discontinuous(target.mesh, target_degree, target_basis)
          : Space::discontinuous(target.mesh,
                                 std::vector<int>(target.element_count(), target_degree),
                                 std::move(target_frames));
  std::vector<Frame> given_donor = in.list<Frame>(), given_target = in.list<Frame>();
  const auto with_given = [&](Group g) {
    g.given_donor_frame = std::move(given_donor);
    g.given_target_frame = std::move(given_target);
    return g;
  };
  if (of_basis) {
    return with_given(Group(donor, target, std::move(donor_space), std::move(target_space),
                            donor_degree, threads));
  }
  const std::vector<double> scaled = in.list<double>();
  std::vector<double> mass = in.list<double>();
  return with_given(Group(donor, target, std::move(donor_space), std::move(target_space),
                          components, donor_degree, scaled, std::move(mass), threads));
}

/// Elements of a part by their numbers in the whole.
void write_numbers(const OverlayMesh& mesh, std::span<const std::int32_t> elements,
                   MessageWriter& out) {
  std::vector<std::int32_t> of_whole;
  for (const std::int32_t e : elements) of_whole.push_back(mesh.number_of(e));
  out.list(of_whole);
}

void write_chunk(const ChunkResult& chunk, const OverlayMesh& donor, const OverlayMesh& target,
                 MessageWriter& out) {
  write_numbers(donor, chunk.given.donor, out);
  write_numbers(target, chunk.given.target, out);
  out.list(chunk.given.area);
  out.list(chunk.given.massed);
  out.list(chunk.given.mass);
  out.value(chunk.counts);
  out.list(chunk.made);
  write_numbers(target, chunk.element_made.element, out);
  out.list(chunk.element_made.mass);
  std::vector<std::int32_t> uncovered;
  std::vector<double> uncovered_area;
  for (const auto& [element, area] : chunk.uncovered) {
    uncovered.push_back(element.value);
    uncovered_area.push_back(area);
  }
  write_numbers(target, uncovered, out);
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

/// All but the products, which only the solve needs.
void write_blocks(const ElementBlocks& blocks, const OverlayMesh& donor, MessageWriter& out) {
  out.value(static_cast<std::uint64_t>(blocks.columns));
  write_numbers(donor, blocks.donor, out);
  out.list(blocks.mass);
  out.list(blocks.value);
  write_numbers(donor, blocks.made_donor, out);
  out.list(blocks.made);
  out.value(blocks.area);
}

void read_blocks(MessageReader& in, ElementBlocks& blocks) {
  blocks.reset(static_cast<std::size_t>(in.value<std::uint64_t>()));
  blocks.donor = in.list<std::int32_t>();
  blocks.mass = in.list<double>();
  blocks.value = in.list<double>();
  blocks.made_donor = in.list<std::int32_t>();
  blocks.made = in.list<double>();
  blocks.area = in.value<double>();
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

ShareWriter::ShareWriter(const OverlayMesh& donor, const OverlayMesh& target,
                         const FrontSearch& search, std::span<const Group> groups,
                         const TransferOptions& options, bool blocks,
                         std::span<const std::uint8_t> rim)
    : donor_(donor),
      target_(target),
      search_(search),
      groups_(groups),
      options_(options),
      blocks_(blocks),
      rim_(rim.begin(), rim.end()),
      donor_place_(donor.mesh->node_count(), -1),
      target_place_(target.mesh->node_count(), -1),
      element_place_(target.element_count(), -1) {
  if (rim.empty()) rim_ = rim_donors(donor, target, search);
}

void ShareWriter::write(const Share& share, MessageWriter& out, const AreaMap& map) {
  out.value(blocks_);
  out.value(options_.uncovered);
  out.value(options_.conserve);
  write_mesh(*donor_.mesh, share.donors, map, donor_place_, out);
  std::vector<std::uint8_t> rim;
  for (const std::int32_t d : share.donors) rim.push_back(rim_[place(d)]);
  out.list(rim);
  out.value(search_.connected());
  write_mesh(*target_.mesh, share.targets, map, target_place_, out);
  note_places(share.targets, element_place_);
  std::vector<std::int32_t> own;
  for (const std::int32_t t : share.own) own.push_back(element_place_[place(t)]);
  forget_places(share.targets, element_place_);
  out.list(own);
  out.value(static_cast<std::uint64_t>(groups_.size()));
  for (const Group& g : groups_) write_group(share, g, donor_, target_, map, out);
}

ShareReport work_on(MessageReader& in, int threads, MessageWriter& out) {
  const Stopwatch watch;
  TransferOptions options;
  options.threads = threads;
  const bool with_blocks = in.value<bool>();
  options.uncovered = in.value<Uncovered>();
  options.conserve = in.value<Conserve>();
  MeshPart donor_part = read_mesh(in);
  const std::vector<std::uint8_t> rim = in.list<std::uint8_t>();
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
  donor.came_from(std::move(donor_part.given_control), donor_part.rounding);
  OverlayMesh target(std::move(target_part.mesh), "target", threads);
  target.numbers = std::move(target_part.numbers);
  target.came_from(std::move(target_part.given_control), target_part.rounding);
  for (std::uint64_t i = 0; i < group_count; ++i)
    groups.push_back(read_group(donor, target, threads, in));
  const FrontSearch search(donor, connected);
  // One writer per chunk: a chunk is one task's.
  std::vector<MessageWriter> blocks(with_blocks ? (own.size() + chunk_size - 1) / chunk_size : 0);
  VisitBlocks visit;
  if (with_blocks) {
    visit = [&](std::size_t index, std::int32_t, const ElementBlocks& of_element) {
      write_blocks(of_element, donor, blocks[index / chunk_size]);
    };
  }
  const std::vector<ChunkResult> chunks =
      sweep_elements(donor, target, search, groups, own, options, {}, visit, rim);
  for (const ChunkResult& chunk : chunks) {
    work.pairs += chunk.counts.pairs;
    write_chunk(chunk, donor, target, out);
  }
  for (MessageWriter& of_chunk : blocks) out.list(of_chunk.take());
  for (std::size_t i = 0; i < groups.size() && !with_blocks; ++i) {
    std::vector<double> coefficients;
    for (const std::int32_t t : own) {
      const auto of_element = groups[i].target_out(t);
      coefficients.insert(coefficients.end(), of_element.begin(), of_element.end());
    }
    out.list(coefficients);
  }
  work.seconds = watch.seconds();
  work.cpu_seconds = watch.cpu_seconds();
  return work;
}

void read_results(const Share& share, MessageReader& in, std::span<Group> groups,
                  std::span<ChunkResult> chunks, const VisitBlocks& visit) {
  for (std::size_t c = 0; c < share.chunk_count; ++c)
    chunks[share.first_chunk + c] = read_chunk(in);
  if (visit) {
    ElementBlocks blocks;
    for (std::size_t c = 0; c < share.chunk_count; ++c) {
      const std::vector<std::byte> bytes = in.list<std::byte>();
      MessageReader of_chunk(bytes);
      const std::size_t end = std::min(share.own.size(), (c + 1) * chunk_size);
      for (std::size_t i = c * chunk_size; i < end; ++i) {
        read_blocks(of_chunk, blocks);
        visit(share.first_chunk * chunk_size + i, share.own[i], blocks);
      }
    }
    return;
  }
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
