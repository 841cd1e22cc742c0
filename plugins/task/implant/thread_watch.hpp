// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "armature/robot/geometry/thread.hpp"
#include "armature/values/time.hpp"
#include "task_implant_parameters.hpp"

namespace armature::task::implant {

/// Whether the handpiece turns an implant as its thread wants it: one that is pushed strips the
/// bone.
class ThreadWatch {
 public:
  explicit ThreadWatch(const Parameters& parameters) : parameters_{parameters} {}

  /// `angle`: how far the handpiece has turned [rad], over all turns.
  void see(double angle, Time now);
  /// An implant begins to go in.
  void engage(const Thread& thread, Time now);
  void release() { thread_.reset(); }
  const std::optional<Thread>& thread() const { return thread_; }
  /// "the implant went in by 1.20 mm, and was turned by 0.3 of the 1 turns that its thread wants",
  /// or that the handpiece is silent, or nullopt. `tool`: where the file's tool is [m].
  std::optional<std::string> trouble(const Eigen::Vector3d& tool, Time now) const;

 private:
  Parameters parameters_;
  std::optional<Thread> thread_;
  std::optional<double> angle_;  // as last told
  double begun_at_ = 0;          // that angle when the implant began to go in
  Time heard_;
};

}  // namespace armature::task::implant
