// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace armature::scene {

/// A number that looks random, of any number (splitmix64; Steele, Lea, Flood 2014). Real-time safe.
inline std::uint64_t splitmix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

}  // namespace armature::scene
