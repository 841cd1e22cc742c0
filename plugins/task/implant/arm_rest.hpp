// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <deque>
#include <optional>
#include <string>

#include "armature/values/time.hpp"

namespace armature::task::implant {

/// How far apart an arm that stands still may measure two places of its flange.
struct Stillness {
  double position_m = 2e-5, angle_rad = 1e-4;

  bool is_left(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to) const;
};

/// After so long at one place an arm that still seems to move is not waited for.
inline constexpr Duration kRestsWithin = seconds(5.0);
/// "the arm does not stand still: ...", for an arm that was `from` and is `to`.
std::string restless(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to);

/// How much an arm's own measurement scatters: its encoders err. Seen from how unevenly the samples
/// follow one another, which a steady motion does not change.
class ArmNoise {
 public:
  /// Every sample of the arm.
  void see(const Eigen::Isometry3d& base_T_flange);
  /// 0.02 mm and 0.1 mrad, or what the noise makes of it: up to 0.2 mm and 1 mrad.
  Stillness stillness() const;

 private:
  struct Change {
    Eigen::Vector3d step, turn;
  };
  std::optional<Eigen::Isometry3d> last_;
  std::optional<Change> change_;      // from the sample before to the last
  std::deque<Stillness> unevenness_;  // how much it differs from the one before, of the last ones
};

}  // namespace armature::task::implant
