// SPDX-License-Identifier: Apache-2.0
#include "goal_chronicle.hpp"

#include <sstream>

namespace armature::test {
namespace {

ToolPose read_pose(std::istream& line) {
  bool pointing = false;
  ToolPose pose;
  Eigen::Vector4d turn;
  line >> pointing;
  for (double& each : pose.position) line >> each;
  for (double& each : turn) line >> each;
  if (pointing) {
    pose.orientation = Direction{turn.head<3>()};
  } else {
    pose.orientation = Eigen::Quaterniond{turn};
  }
  return pose;
}

GivenZone read_zone(std::istream& line) {
  GivenZone zone;
  line >> zone.name;
  for (double& each : zone.from) line >> each;
  for (double& each : zone.to) line >> each;
  line >> zone.radius >> zone.tool_enters;
  return zone;
}

}  // namespace

GoalChronicle read_goals(const std::string& text, int dof) {
  GoalChronicle told;
  std::istringstream lines{text};
  for (std::string one; std::getline(lines, one);) {
    std::istringstream line{one};
    std::string kind;
    int id = 0;
    double time_s = 0;
    line >> kind;
    if (kind == "pose" && line >> id) told.goals[id].poses.push_back(read_pose(line));
    if (kind == "zone" && line >> id) told.goals[id].zones.push_back(read_zone(line));
    if (kind == "ref" || kind == "arm") {
      ArmRow row;
      line >> row.time_s;
      for (JointVector* values : {&row.q, &row.v, &row.a}) {
        values->setZero(dof);
        if (kind == "arm" && values != &row.q) continue;
        for (int i = 0; i < dof; ++i) line >> (*values)[i];
      }
      (kind == "ref" ? told.reference : told.arm).push_back(row);
      continue;
    }
    told.story += one + "\n";
    if (kind == "pose" || kind == "zone") continue;
    line >> time_s;
    if (kind == "stop") told.stops_s.push_back(time_s);
    if (kind == "last") line >> told.last;
    if (kind == "goal") {
      int mode = 0;
      line >> id >> mode;
      GivenGoal& goal = told.goals[id];
      goal.time_s = time_s;
      goal.mode = static_cast<GivenGoal::Mode>(mode);
      line >> goal.max_speed >> goal.stepwise >> goal.what;
    }
    if (kind == "status") {
      GoalStatusLine status{.time_s = time_s};
      line >> status.id >> status.state >> std::ws;
      std::getline(line, status.stage, '|');
      std::getline(line, status.reason);
      told.statuses.push_back(status);
    }
  }
  return told;
}

}  // namespace armature::test
