#pragma once
// Internal: lists in objects that are made anew for each element.

#include <vector>

namespace bezel::detail {

/// A vector that keeps its storage when an empty one is assigned to it.
template <class T>
struct Refilled : std::vector<T> {
  using std::vector<T>::vector;
  Refilled(const Refilled&) = default;
  Refilled& operator=(const Refilled& other) {
    if (other.empty())
      this->clear();
    else
      std::vector<T>::operator=(other);
    return *this;
  }
  ~Refilled() = default;
};

}  // namespace bezel::detail
