// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "armature/robot/joint_vector.hpp"
#include "armature/values/time.hpp"

namespace armature {

/// Tells by an arm's own samples whether it rests: no joint was farther than 1e-4 rad (or 0.1 mm)
/// from one place for 50 ms. Real-time safe.
class RestWatch {
 public:
  void see(const JointVector& q, Time stamp) {
    if (since_ && (q - place_).cwiseAbs().maxCoeff() <= kStill) {
      seen_ = stamp;
      return;
    }
    place_ = q;
    since_ = seen_ = stamp;
  }
  bool rests() const { return since_ && seen_ - *since_ >= seconds(0.05); }

 private:
  static constexpr double kStill = 1e-4;
  JointVector place_;
  std::optional<Time> since_;
  Time seen_;
};

}  // namespace armature
