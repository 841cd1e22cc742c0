// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace armature::test {

/// What `test/any_operator` wrote of a run, in the order in which it saw it.
struct OperatorChronicle {
  /// Where the arm was from then on: all joints, [rad] or [m].
  struct Arm {
    double time_s = 0;
    std::vector<double> joints;
  };
  /// That has a pose and a path.
  struct Goal {
    double time_s = 0;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    std::optional<Eigen::Vector3d> focus;
  };
  struct Task {
    double time_s = 0;
    bool asks = false, paused = false;
    std::string state, step, detail;
  };
  /// Something stopped it (what: "stop", "hold", "power"), or ended: "over", "rearmed"; and motion
  /// telling so from then on ("stopped"), or no more ("not stopped").
  struct Mishap {
    double time_s = 0;
    std::string what;
  };
  struct Word {
    double time_s = 0;
    std::uint64_t id = 0;
    std::string word, step;
    std::optional<std::string> answer;  // empty: it was obeyed
    double answered_s = 0;

    bool obeyed() const { return answer && answer->empty(); }
  };

  std::string text;
  std::vector<Arm> arm;
  std::vector<Goal> goals;
  std::vector<Task> task;
  std::vector<Word> words;
  std::vector<Mishap> mishaps;
  double end_s = 0;

  /// What was said and what became of it, for messages.
  std::string story() const;
};

OperatorChronicle read_operator_chronicle(const std::string& text);

}  // namespace armature::test
