// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "armature/robot/model/robot_model.hpp"
#include "envelope.hpp"
#include "joint_table.hpp"

namespace armature::report::joints {

/// The rows of a table as one picture: positions, speeds and errors of the joints, joints that turn
/// and joints that slide apart, and the errors of the tool. Its memory is bounded.
class JointPlot {
 public:
  /// Keeps a reference to `model`.
  explicit JointPlot(const RobotModel& model);

  void add(const JointRow& row);
  std::string svg() const;

 private:
  const RobotModel& model_;
  Envelope envelope_;  // position, speed and error of every joint; of the tool [m] and [rad]
};

}  // namespace armature::report::joints
