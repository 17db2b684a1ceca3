#pragma once
// Internal: bytes between processes (MPI), in builds that have it (BEZEL_WITH_MPI).

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace bezel::detail {

using Bytes = std::vector<std::byte>;

/// What a message to a serving process asks for.
enum class Order : std::uint8_t { work, make_rows, add_blocks, finish_rows, solve, drop_rows, end };

/// How a serving process fared.
enum class Outcome : std::uint8_t { done, bad_input, gave_up, no_memory, other };

void send(int to, std::span<const std::byte> bytes);

/// Waits without keeping a core busy: rank 0 reads files, and others work, meanwhile.
Bytes receive(int from);

/// An answer that says what went wrong: the exception at work.
Bytes failure();

/// Throws what failure() was made of.
[[noreturn]] void rethrow(Outcome outcome, const std::string& message);

}  // namespace bezel::detail
