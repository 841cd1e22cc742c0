// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>

#include "armature/robot/geometry/thread.hpp"

namespace armature::report::implant {

/// Whether an implant is turned as it goes in: how far it went in, against its turns.
class ThreadMonitor {
 public:
  /// With the thread of one implant.
  void engage(const std::optional<Thread>& thread) {
    thread_ = thread;
    begun_at_.reset();
  }
  /// At one instant: where the file's tool is [m], and how far the handpiece has turned [rad].
  void see(const Eigen::Vector3d& tool, double angle);
  /// [m] The most that an implant was ahead of its turns or behind them, if any was seen, and no
  /// angle was no number.
  const std::optional<double>& max_error_m() const { return max_error_m_; }

 private:
  std::optional<Thread> thread_;
  std::optional<double> begun_at_;  // its angle, when it was engaged
  std::optional<double> max_error_m_;
  bool is_known_ = true;
};

}  // namespace armature::report::implant
