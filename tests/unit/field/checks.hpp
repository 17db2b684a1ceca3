#pragma once
// Checks shared by the tests of this module.

#include <initializer_list>
#include <string>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/formula/formula.hpp"

namespace bezel::field_test {

/// what() of the InputError that action throws.
template <class Action>
std::string message_of(Action&& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

inline std::vector<Formula> formulas(std::initializer_list<const char*> texts) {
  std::vector<Formula> all;
  for (const char* text : texts) all.emplace_back(text);
  return all;
}

}  // namespace bezel::field_test
