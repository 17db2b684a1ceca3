#pragma once
// Random changes of a text.

#include <cstdint>
#include <string>
#include <vector>

#include "bezel/base/random.hpp"

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

}  // namespace bezel::test
