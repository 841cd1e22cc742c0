// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "rrp_structure.hpp"

namespace armature {

/// The wrist's rotation M = cosine cos(theta1) + sine sin(theta1) + rest while a base turns whose
/// axis 1 runs along the slide.
struct TurningWrist {
  Eigen::Matrix3d cosine, sine, rest;

  /// From M at theta1 = 0, pi / 2 and pi.
  TurningWrist(const Eigen::Matrix3d& at_0, const Eigen::Matrix3d& at_quarter,
               const Eigen::Matrix3d& at_half)
      : cosine{(at_0 - at_half) / 2},
        sine{at_quarter - (at_0 + at_half) / 2},
        rest{(at_0 + at_half) / 2} {}
};

/// Values of theta1 [rad].
class TurnsOnLimits {
 public:
  void add(double theta1) { turns_[count_++] = theta1; }
  double* begin() { return turns_.data(); }
  double* end() { return turns_.data() + count_; }

 private:
  static constexpr std::size_t kCapacity = 24;  // 2 of joint 1, 12 + 8 of the wrist, 2 of its poles
  std::array<double, kCapacity> turns_{};
  std::size_t count_ = 0;
};

/// Every theta1 at which joint 1 or a joint of the wrist stands on a limit, or both joints 4 and 6
/// of a singular wrist do, and where theta5 comes nearest to the singular wrist. Where the limits
/// can be kept, but not at every theta1, they are kept at one of these: each such range ends at
/// one. Some of them serve a half-turned joint, so whoever takes one looks at the limits again.
/// Joints without limits add none. Real-time safe.
TurnsOnLimits turns_on_limits(const RrpArm& arm, const TurningWrist& wrist);

}  // namespace armature
