// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "armature/robot/geometry/pose_goal.hpp"
#include "armature/robot/model/robot_model.hpp"

namespace armature::test {

struct GivenZone {
  std::string name;
  Eigen::Vector3d from, to;
  double radius = 0;
  bool tool_enters = false;
};

struct GivenGoal {
  enum class Mode { planned, tracking, hold, guided, pause, resume, retrace };
  double time_s = 0, max_speed = 0;
  Mode mode = Mode::planned;
  bool stepwise = false;
  std::string what;
  std::vector<ToolPose> poses;  // key poses, and where it ends
  std::vector<GivenZone> zones;
};

struct GoalStatusLine {
  enum State { accepted, executing, done, superseded, failed };
  double time_s = 0;
  int id = 0, state = 0;
  std::string stage, reason;
};

struct ArmRow {
  double time_s = 0;
  JointVector q, v, a;
  bool rests() const { return v.isZero(1e-12); }
};

/// What the chronicle of a run tells.
struct GoalChronicle {
  std::map<int, GivenGoal> goals;
  std::vector<GoalStatusLine> statuses;
  std::vector<ArmRow> reference, arm;
  std::vector<double> stops_s;
  std::string story;
  int last = 0;
};

/// `text` as test/any_goal writes it, of an arm with so many joints that move by themselves.
GoalChronicle read_goals(const std::string& text, int dof);

}  // namespace armature::test
