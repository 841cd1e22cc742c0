// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <utility>

#include "armature/robot/model/joint_vector.hpp"
#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// Tells by an arm's own samples whether it rests: no joint was farther than its tolerance from one
/// place for `kRests_s`. Real-time safe.
class RestWatch {
 public:
  static constexpr double kRests_s = 0.05;

  /// [rad] or [m] of each independent joint: more than the noise of its encoder.
  explicit RestWatch(JointVector tolerance) : tolerance_{std::move(tolerance)} {}

  void see(const JointVector& q, Time stamp) {
    if (since_ && ((q - place_).cwiseAbs().array() <= tolerance_.array()).all()) {
      seen_ = stamp;
      return;
    }
    place_ = q;
    since_ = seen_ = stamp;
  }
  /// What was seen says nothing any more.
  void forget() { since_.reset(); }
  bool rests() const { return since_ && seen_ - *since_ >= seconds(kRests_s); }

 private:
  JointVector tolerance_, place_;
  std::optional<Time> since_;
  Time seen_;
};

}  // namespace armature
