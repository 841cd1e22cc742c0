// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>

namespace armature {

/// Bits that were drawn, as a number from 0 to below 1. The distributions of std:: make other ones
/// of them with another standard library.
constexpr double share_of(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

/// Numbers that a seed draws, the same ones everywhere.
class Chance {
 public:
  explicit Chance(std::uint64_t seed) : random_{seed} {}

  std::uint64_t bits() { return random_(); }
  /// From 0 to below 1.
  double share() { return share_of(bits()); }
  double between(double from, double to) { return from + (to - from) * share(); }
  bool happens(double probability) { return share() < probability; }
  /// From 0 to below `count`.
  int below(int count) { return static_cast<int>(between(0, count)); }

 private:
  std::mt19937_64 random_;
};

}  // namespace armature
