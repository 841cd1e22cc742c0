// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>
#include <span>
#include <string_view>

#include "bench/perception/cases.hpp"

namespace armature::bench {

/// Glasses or a beard of a drawn face, which lead landmark finders astray.
enum class FaceWears { nothing, glasses, beard };

/// Numbers that are the same in every standard library.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_{seed} {}
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53;
  }
  /// The same, or its opposite.
  double either_side(double low, double high) {
    const double value = between(low, high);
    return random_() >> 63 ? value : -value;
  }
  /// The seed of one of six drawn faces that wear this and nothing else.
  std::uint64_t face(FaceWears what);

 private:
  std::mt19937_64 random_;
};

/// A case as it is drawn: the face looks along the cameras' axes but for its angles, and its mouth
/// is `aside` right of the middle between them and `below` it.
struct DrawnCase {
  PerceptionCase drawn;
  double distance_m = 0.6, aside_m = 0, below_m = 0;
  double yaw = 0, pitch = 0, roll = 0;  // [rad]
  Eigen::Vector3d late_m =
      Eigen::Vector3d::Zero();  // how far the face was elsewhere for the right camera
};

/// A kind of cases: `draw` changes what every case has; of a sequence in which it begins, what the
/// cases from the kSoundPairs-th on have.
struct CaseGroup {
  std::string_view name;
  void (*draw)(DrawnCase& one, Draw& draw);
  enum class Sequence { none, tracked, with_lost_frames, it_begins } sequence = Sequence::none;
};

inline constexpr int kSoundPairs = 3;  // of a sequence, before something begins

std::span<const CaseGroup> case_groups();

}  // namespace armature::bench
