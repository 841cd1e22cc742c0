// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "replay/replayed_process.hpp"
#include "replay/watched_ik.hpp"

namespace armature {

/// One of the two that are compared, with its solvers of inverse kinematics watched.
struct ComparedSide {
  struct Solver {
    std::string component, plugin, robot, params;
    IkCalls calls;
  };

  /// Throws what ReplayedProcess throws. `run` and `plugins` outlive it.
  ComparedSide(RecordedRun& run, PluginRegistry& plugins,
               const std::vector<std::string>& assignments,
               const std::vector<std::string>& changed);

  ReplayedProcess process;
  std::deque<Solver> solvers;  // stay where they are

 private:
  void watch(const std::string& name, ReplayedComponent& component, PluginRegistry& plugins);
  std::string given_params(const ComponentConfig& component, const std::string& slot) const;
  std::string robot_of(const ComponentConfig& component) const;
};

}  // namespace armature
