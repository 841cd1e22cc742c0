// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "armature/kinds/joint_messages.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"
#include "armature/values/angles.hpp"

namespace armature::sim::photo_scene {

inline const std::string kLamp = ARMATURE_SOURCE_DIR "/configs/robots/dental_lamp.yaml";

/// Small cameras: quick to draw.
inline config::Node small_rig(const std::string& mount = "tool") {
  return config::parse_text(
      "{armature_rig: 1, name: small, resolution: [160, 90], fov_deg: 70, baseline_mm: 120, "
      "mount: {frame: " +
          mount + ", forward: [1, 0, 0], right: [0, 0, 1]}}",
      "rig.yaml");
}

inline ComponentHarness::Options scene_with(const std::string& params) {
  return {.component = "{plugin: sim/photo_scene, params: {" + params + "}}",
          .robot = config::load(kLamp),
          .rig = small_rig()};
}

/// Parameters that put the face 30 cm in front of the cameras of the resting arm, and look at them.
inline std::string in_view(const std::string& more) {
  const RobotModel lamp = load_robot_model(kLamp);
  const Eigen::Isometry3d tool = forward_kinematics(lamp, resting_position(lamp), lamp.tool());
  const Eigen::Vector3d forward = tool.linear().col(0), mouth = tool * Eigen::Vector3d{0.3, 0, 0};
  return fmt::format("mouth_m: [{}, {}, {}], tilt_up_deg: {}, tilt_side_deg: {}, {}", mouth.x(),
                     mouth.y(), mouth.z(), std::asin(-forward.z()) / kRadPerDegree,
                     std::atan2(-forward.y(), forward.x()) / kRadPerDegree, more);
}

inline double mean(const msg::Image& image) {
  return std::accumulate(image.data_().begin(), image.data_().end(), 0.0) /
         static_cast<double>(image.data_().size());
}

/// A scene before an arm that rests, or that stands where it is told.
class ScenePictures {
 public:
  explicit ScenePictures(const std::string& params) : scene{built_plugins(), scene_with(params)} {}

  void arm_at(double stamp_s, double first_joint_rad = 0) {
    JointVector q = resting_position(lamp_);
    q[0] += first_joint_rad;
    msg::JointState arm;
    write_all_joints(lamp_, q, JointVector::Zero(5), Time{} + seconds(stamp_s), arm);
    scene.send("measured_js", arm);
  }
  struct Pairs {
    std::vector<msg::Image> left, right;
  };
  /// The pairs of one step, at most one.
  Pairs step(double t_s, double first_joint_rad = 0) {
    arm_at(t_s, first_joint_rad);
    scene.step(t_s);
    return {scene.take<msg::Image>("left_image"), scene.take<msg::Image>("right_image")};
  }
  struct Pair {
    msg::Image left, right;
  };
  Pair pair(double t_s, double first_joint_rad = 0) {
    auto [left, right] = step(t_s, first_joint_rad);
    EXPECT_TRUE(left.size() == 1 && right.size() == 1);
    if (left.size() != 1 || right.size() != 1) return {};
    return {left.front(), right.front()};
  }

  ComponentHarness scene;

 private:
  const RobotModel lamp_ = load_robot_model(kLamp);
};

}  // namespace armature::sim::photo_scene
