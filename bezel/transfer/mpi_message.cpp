#include "bezel/transfer/mpi_message.hpp"

#ifdef BEZEL_WITH_MPI
// The C interface is all that is used.
#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <new>
#include <thread>

#include "bezel/base/error.hpp"
#include "bezel/transfer/message.hpp"

namespace bezel::detail {
namespace {

constexpr int size_tag = 1, bytes_tag = 2;
/// MPI counts bytes in an int.
constexpr std::size_t largest_piece = std::size_t{1} << 30;

Bytes outcome_bytes(Outcome outcome, const std::string& message) {
  MessageWriter out;
  out.value(outcome);
  out.text(message);
  return out.take();
}

}  // namespace

void send(int to, std::span<const std::byte> bytes) {
  auto size = static_cast<std::uint64_t>(bytes.size());
  MPI_Send(&size, 1, MPI_UINT64_T, to, size_tag, MPI_COMM_WORLD);
  for (std::size_t at = 0; at < bytes.size(); at += largest_piece) {
    const std::size_t piece = std::min(largest_piece, bytes.size() - at);
    MPI_Send(bytes.data() + at, static_cast<int>(piece), MPI_BYTE, to, bytes_tag, MPI_COMM_WORLD);
  }
}

Bytes receive(int from) {
  int there = 0;
  for (auto pause = std::chrono::microseconds(10);;) {
    MPI_Iprobe(from, size_tag, MPI_COMM_WORLD, &there, MPI_STATUS_IGNORE);
    if (there != 0) break;
    std::this_thread::sleep_for(pause);
    pause = std::min(2 * pause, std::chrono::microseconds(1000));
  }
  std::uint64_t size = 0;
  MPI_Recv(&size, 1, MPI_UINT64_T, from, size_tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  Bytes bytes(static_cast<std::size_t>(size));
  for (std::size_t at = 0; at < bytes.size(); at += largest_piece) {
    const std::size_t piece = std::min(largest_piece, bytes.size() - at);
    MPI_Recv(bytes.data() + at, static_cast<int>(piece), MPI_BYTE, from, bytes_tag, MPI_COMM_WORLD,
             MPI_STATUS_IGNORE);
  }
  return bytes;
}

Bytes failure() {
  try {
    throw;
  } catch (const InputError& error) {
    return outcome_bytes(Outcome::bad_input, error.what());
  } catch (const NumericsError& error) {
    return outcome_bytes(Outcome::gave_up, error.what());
  } catch (const std::bad_alloc&) {
    return outcome_bytes(Outcome::no_memory, "");
  } catch (const std::exception& error) {
    return outcome_bytes(Outcome::other, error.what());
  }
}

void rethrow(Outcome outcome, const std::string& message) {
  switch (outcome) {
    case Outcome::bad_input:
      throw InputError(message);
    case Outcome::gave_up:
      throw NumericsError(message);
    case Outcome::no_memory:
      throw std::bad_alloc();
    default:
      throw InternalError(message);
  }
}

}  // namespace bezel::detail

#endif
