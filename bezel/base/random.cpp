#include "bezel/base/random.hpp"

#include <bit>
#include <cmath>

namespace bezel {
namespace {

std::uint64_t fnv1a(std::uint64_t hash, std::uint8_t byte) {
  return (hash ^ byte) * 0x100000001b3u;
}

std::uint64_t splitmix64(std::uint64_t& state) {
  std::uint64_t z = state += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

}  // namespace

RandomStream::RandomStream(std::string_view name, std::uint64_t seed) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : name) hash = fnv1a(hash, static_cast<std::uint8_t>(c));
  for (int k = 0; k < 64; k += 8) hash = fnv1a(hash, static_cast<std::uint8_t>(seed >> k));
  for (auto& word : state_) word = splitmix64(hash);
}

std::uint64_t RandomStream::next() {
  const std::uint64_t result = std::rotl(state_[1] * 5, 7) * 9;
  const std::uint64_t t = state_[1] << 17;
  state_[2] ^= state_[0];
  state_[3] ^= state_[1];
  state_[1] ^= state_[2];
  state_[0] ^= state_[3];
  state_[2] ^= t;
  state_[3] = std::rotl(state_[3], 45);
  return result;
}

double RandomStream::uniform() {
  return static_cast<double>(next() >> 11) * 0x1p-53;
}

double RandomStream::uniform(double lo, double hi) {
  const double x = lo + (hi - lo) * uniform();
  // lo + (hi - lo) u may round up to hi.
  return x < hi || !(lo < hi) ? x : std::nextafter(hi, lo);
}

std::uint64_t RandomStream::below(std::uint64_t n) {
  // 2^64 mod n values at the bottom are drawn again: the rest is a multiple of n.
  const std::uint64_t rejected = (0 - n) % n;
  std::uint64_t r = next();
  while (r < rejected) r = next();
  return r % n;
}

}  // namespace bezel
