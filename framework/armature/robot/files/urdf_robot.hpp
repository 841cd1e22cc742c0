// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "armature/config/problems.hpp"
#include "armature/robot/model/robot_model.hpp"

namespace armature ARMATURE_EXPORT {

/// A link of a URDF file and where the user named it.
struct LinkName {
  std::string name;
  config::Origin origin;
};

/// What a URDF file tells of the arm between two of its links, as a robot model takes it: modified
/// Denavit-Hartenberg rows (see denavit_hartenberg.hpp), and a frame for every link from the base
/// to the tip.
struct UrdfArm {
  std::string name;
  std::vector<Joint> joints;
  std::vector<config::Origin> places;  // where each joint is written
  std::vector<NamedFrame> frames;
  FrameId tip{};
  /// The tip once more by the name that rigs are mounted on; none where a link of the file has it.
  std::optional<NamedFrame> tool;
  /// Names of joints, and of links that are not between base and tip: why that is no frame, and
  /// what to name. A name that is a frame's, too, is not among them.
  std::map<std::string, std::string> no_frames;
};
/// `named_at`: where `file` is named. `base` without a name: the root link. Every problem goes to
/// `problems`; with one the arm may be incomplete.
UrdfArm read_urdf_arm(const std::filesystem::path& file, const config::Origin& named_at,
                      const LinkName& base, const LinkName& tip, config::Problems& problems);

/// Notes every joint that has no room to move, or a speed below 0, by the file; `joints` are the
/// arm's as they shall be: one that says otherwise by now or is locked is not looked at.
void check_urdf_limits(const UrdfArm& arm, const std::vector<Joint>& joints,
                       config::Problems& problems);

/// The arm as a robot by itself: its tool is the tip, its goals are rotations, and a joint whose
/// speed the file does not limit has no such limit. Throws config::ConfigError.
RobotModel load_urdf_robot(const std::filesystem::path& file, const LinkName& base,
                           const LinkName& tip);

}  // namespace armature
