#include "bezel/base/error.hpp"

#include <utility>

namespace bezel {
namespace {

std::string compose(const InputPlace& place, const std::string& message) {
  std::string text;
  if (!place.file.empty()) {
    text += place.file;
    if (place.line > 0) text.append(":").append(std::to_string(place.line));
    text += ": ";
  } else if (place.line > 0) {
    text.append("line ").append(std::to_string(place.line)).append(": ");
  }
  if (!place.element_kind.empty()) {
    text += place.element_kind;
    if (place.element >= 0) text.append(" ").append(std::to_string(place.element));
    text += ": ";
  }
  return text + message;
}

}  // namespace

InputError::InputError(InputPlace place, const std::string& message)
    : Error(compose(place, message)), place_(std::move(place)), message_(message) {}

InputError InputError::in_file(const std::string& file, std::int64_t line) const {
  InputPlace place = place_;
  if (place.file.empty()) place.file = file;
  if (place.line == 0) place.line = line;
  return InputError(std::move(place), message_);
}

InternalError::InternalError(const std::string& message)
    : Error("internal error: " + message + "; this is a bug, please send the input") {}

}  // namespace bezel
