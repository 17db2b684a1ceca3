#pragma once
// Arrays of numbers that are written before they are read.

#include <memory>
#include <new>
#include <vector>

namespace bezel {

/// Leaves numbers as they are where a vector would set them to 0: large arrays need not be written
/// twice.
template <class T>
struct UnsetAllocator : std::allocator<T> {
  template <class U>
  struct rebind {
    using other = UnsetAllocator<U>;
  };
  UnsetAllocator() = default;
  template <class U>
  explicit UnsetAllocator(const UnsetAllocator<U>&) {}
  template <class U>
  void construct(U* p) {
    ::new (static_cast<void*>(p)) U;
  }
};

/// resize() leaves new numbers unset.
using Numbers = std::vector<double, UnsetAllocator<double>>;

}  // namespace bezel
