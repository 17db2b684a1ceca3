#pragma once
// What an input error says.

#include <string>

#include "bezel/base/error.hpp"

namespace bezel::test {

/// The text of the InputError that an action throws, or "no InputError".
template <class Action>
std::string message_of(Action&& action) {
  try {
    (void)action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no InputError";
}

}  // namespace bezel::test
