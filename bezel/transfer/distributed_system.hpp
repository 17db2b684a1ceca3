#pragma once
// Internal: mass systems that PETSc solves in several processes.

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "bezel/transfer/distributed.hpp"
#include "bezel/transfer/dof_split.hpp"
#include "bezel/transfer/message.hpp"
#include "bezel/transfer/mpi_message.hpp"

namespace bezel::detail {

/// On rank 0: a system whose rows are spread over all processes.
///
/// Element blocks go to the processes that own one of their rows, right-hand sides and solutions in
/// parts. PETSc's own calls are made by all processes together: what it refuses (an option, say) it
/// refuses everywhere.
class DistributedSystem final : public MassSystem {
 public:
  /// @param number  of the system, another one for each
  /// @param shares  of the processes: bytes and seconds are added; must outlive the system
  DistributedSystem(std::int32_t number, const Space& space, std::vector<ShareReport>& shares);
  ~DistributedSystem() override;

  void add(std::span<const std::int32_t> dofs, std::span<const double> block) override;
  void finish() override;
  int solve(std::span<const double> right, double smallest, std::span<double> x) override;

 private:
  struct Peer {
    MessageWriter blocks;
    std::size_t waiting = 0;  // bytes of blocks not sent yet
  };
  MessageWriter order(Order what) const;
  void tell(std::size_t process, MessageWriter& message);
  void send_blocks(std::size_t process);
  /// Calls own() here while the others do what they were told, and takes their answers: own()'s
  /// error is thrown, else the first of theirs.
  template <class Own, class Take>
  void together(const Own& own, const Take& take);

  std::int32_t number_;
  std::vector<ShareReport>& shares_;
  DofSplit split_;
  std::vector<Peer> peers_;
  std::unique_ptr<PetscRows> rows_;  // of rank 0
};

/// On the other ranks: their rows of the systems that rank 0 has.
class ServedRows {
 public:
  /// Does what an order says, and answers where it asks for that.
  void obey(Order order, MessageReader& in);

 private:
  struct System {
    std::unique_ptr<PetscRows> rows;
    std::size_t size = 0;
    Bytes error;  // of blocks, which ask for no answer; empty: none
  };
  std::map<std::int32_t, System> systems_;
};

}  // namespace bezel::detail
