#pragma once
// Checks shared by the tests of this module.

#include <initializer_list>
#include <string>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/formula/formula.hpp"
#include "support/message_of.hpp"

namespace bezel::field_test {

using test::message_of;

inline std::vector<Formula> formulas(std::initializer_list<const char*> texts) {
  std::vector<Formula> all;
  for (const char* text : texts) all.emplace_back(text);
  return all;
}

}  // namespace bezel::field_test
