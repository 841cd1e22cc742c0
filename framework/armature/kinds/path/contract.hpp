// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <ostream>
#include <random>
#include <string>

#include "armature/kinds/path/path.hpp"

// The laws that every `path` plugin keeps. In the plugin's test, in one source file:
//
//   INSTANTIATE_TEST_SUITE_P(MouthArc, PathLaws, testing::Values(...));
namespace armature {

struct PathSubject {
  std::string name;
  std::shared_ptr<const PathPlanner> planner;
  /// A goal's axis is a line through the point to look at, and the way along it from before that
  /// point: it is asked for nothing else.
  bool along_a_line = false;

  friend void PrintTo(const PathSubject& subject, std::ostream* out) { *out << subject.name; }
};

class PathLaws : public testing::TestWithParam<PathSubject> {
 protected:
  static constexpr double kRounding = 1e-9;  // [rad], and of a length
  const PathPlanner& planner() const { return *GetParam().planner; }

  Eigen::Vector3d random_unit();
  Eigen::Quaterniond random_rotation();
  double between(double low, double high);
  /// Before the focus, looking at it up to `miss` [rad] off.
  ToolPose looking_at_focus(double distance, double miss);
  static double angle_between(const Orientation& a, const Orientation& b);
  static void expect_same(const ToolPose& a, const ToolPose& b);
  static void expect_finite_unit(const ToolPose& pose);
  static void expect_sound_segment(const PathSegment& segment, const ToolPose& from);
  /// Every key pose is a sample, in their order.
  static void expect_passes_key_poses(const Path& path, const PathRequest& request);
  static void expect_sound(const Path& path, const PathRequest& request);
  void expect_planned(const PathRequest& request);
  /// `usual`, or 0 where a goal has to look at its focus exactly.
  double miss(double usual) const { return GetParam().along_a_line ? 0 : usual; }
  /// Towards the focus; along a line from before it.
  PathRequest towards_focus(ToolPose start, const ToolPose& goal) const;

  const Eigen::Vector3d kFocus{1.55, 0, 0.45};
  std::mt19937_64 random_{17};
  std::normal_distribution<double> normal_;
};

}  // namespace armature
