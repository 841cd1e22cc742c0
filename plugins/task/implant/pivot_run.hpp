// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "armature/calibration/pivot.hpp"
#include "armature/values/expected.hpp"
#include "sighting.hpp"
#include "task_implant_parameters.hpp"

namespace armature::task::implant {

/// A tool in the hand is watched while it is turned about its tip.
class PivotRun {
 public:
  /// `tool` as in "the drill".
  PivotRun(const Parameters& parameters, const std::string& tool);

  /// From now on the tool has to be seen; else from when it is seen first.
  void begin(Time now);
  void see(const Sighting& sighting);
  /// It has been watched for long enough.
  bool complete(Time now) const;
  /// Why the tool is not seen, or nullopt.
  std::optional<std::string> blind(Time now) const;
  /// What was found, or why it is not trusted.
  Expected<Pivot> result() const;
  int poses() const { return static_cast<int>(poses_.size()); }

 private:
  Parameters parameters_;
  BodyWatch watch_;
  std::vector<Eigen::Isometry3d> poses_;
  bool begun_ = false;
  std::optional<Time> since_;
};

}  // namespace armature::task::implant
