#pragma once
// Errors of the library: bad input, internal mistakes, and promises between our own functions.

#include <cstdint>
#include <stdexcept>
#include <string>

namespace bezel {

/// Root of every exception Bezel throws.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Where in a user's input something was found. Unknown parts stay at their default.
struct InputPlace {
  std::string file;           ///< path as the user gave it; empty when the input is no file
  std::int64_t line = 0;      ///< 1-based; 0 when unknown
  std::string element_kind;   ///< "triangle", "node", "field" …; empty when unknown
  std::int64_t element = -1;  ///< number as the user knows it; -1 when unknown
};

/// Bad input: a file, an option, an argument or an array from a caller.
///
/// what() is one line "file:line: kind number: message", without the parts that are unknown, lower
/// case, no full stop; the message says what was found and what was expected.
class InputError : public Error {
 public:
  explicit InputError(const std::string& message) : InputError(InputPlace{}, message) {}
  InputError(InputPlace place, const std::string& message);

  const InputPlace& place() const noexcept { return place_; }
  /// The message without the place.
  const std::string& message() const noexcept { return message_; }
  /// The same error with the file (and line) filled in where they were unknown.
  InputError in_file(const std::string& file, std::int64_t line = 0) const;

 private:
  InputPlace place_;
  std::string message_;
};

/// The numerics gave up on legitimate input (no convergence, unresolved geometry). what() says
/// where.
class NumericsError : public Error {
 public:
  using Error::Error;
};

/// "Cannot happen": a mistake of ours. what() asks for the input to be sent.
class InternalError : public Error {
 public:
  explicit InternalError(const std::string& message);
};

/// A promise between our own functions: throws InternalError in debug builds, absent in release.
/// Never the only guard for user data.
#ifdef NDEBUG
inline void assume(bool, const char* = "") {}
#else
inline void assume(bool holds, const char* what = "broken promise") {
  if (!holds) throw InternalError(what);
}
#endif

}  // namespace bezel
