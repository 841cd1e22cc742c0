// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "armature/values/chance.hpp"
#include "bench/perception/cases.hpp"

namespace armature::bench {

/// Glasses or a beard of a drawn face, which lead landmark finders astray.
enum class FaceWears { nothing, glasses, beard };

/// A generator of what differs between cases.
class Draw : public Chance {
 public:
  using Chance::Chance;
  /// The same, or its opposite.
  double either_side(double low, double high) {
    const double value = between(low, high);
    return bits() >> 63 ? value : -value;
  }
  /// The seed of one of six drawn faces that wear this and nothing else.
  std::uint64_t face(FaceWears what);
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
