#pragma once
// Random changes of texts that commands read, and the checks of how they are refused.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/base/random.hpp"
#include "tests/fuzz/try_many.hpp"

namespace bezel::test {

/// The text after 1 to 4 changes: a byte, a digit, a word put in, a piece cut out or copied.
inline std::string mutated(std::string text, const std::vector<std::string>& words,
                           RandomStream& random) {
  for (std::uint64_t changes = 1 + random.below(4); changes > 0 && !text.empty(); --changes) {
    const auto at = static_cast<std::size_t>(random.below(text.size()));
    switch (random.below(5)) {
      case 0:
        text[at] = static_cast<char>(random.below(256));
        break;
      case 1:
        text[at] = static_cast<char>('0' + random.below(10));
        break;
      case 2:
        text.insert(at, words[random.below(words.size())]);
        break;
      case 3:
        text.erase(at, 1 + random.below(5));
        break;
      default:
        text.insert(static_cast<std::size_t>(random.below(text.size())),
                    text.substr(at, 1 + random.below(20)));
    }
  }
  return text;
}

/// Runs `read`, which throws std::logic_error where a check of what it read fails.
/// @return whether the text was read; false for an InputError that is one line of printable text
///         and begins with the name of the file, "fuzz.json"
template <class Read>
bool read_or_refused(const Read& read) {
  try {
    read();
    return true;
  } catch (const InputError& error) {
    const std::string what = error.what();
    if (what.rfind("fuzz.json:", 0) != 0) throw std::logic_error("no place: " + what);
    for (const char c : what)
      if (c < ' ' || c > '~') throw std::logic_error("a message that is not one line of text");
    return false;
  }
}

/// Tries mutations of the seeds in turn; read(text) says whether it was read.
template <class Read>
void try_mutations(const std::string& stream, std::size_t tries,
                   const std::vector<std::string>& seeds, const std::vector<std::string>& words,
                   Read&& read) {
  constexpr std::uint64_t number = 20261128;
  RandomStream random(stream, number);
  std::size_t next = 0;
  fuzz::try_many(
      {tries, std::chrono::seconds(60), 0.25, 0.01},
      [&] { return mutated(seeds[next++ % seeds.size()], words, random); }, read,
      [](const std::string& text) { return "of seed " + std::to_string(number) + "\n" + text; });
}

}  // namespace bezel::test
