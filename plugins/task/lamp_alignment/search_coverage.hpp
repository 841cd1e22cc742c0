// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "armature/robot/files/stereo_rig.hpp"
#include "armature/robot/geometry/pose_goal.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "task_lamp_alignment_parameters.hpp"

namespace armature::task::lamp_alignment {

/// A face before the lamp. At tilt 0 it looks along -x of the base; `tilt_up` turns its normal
/// towards +z, `tilt_side` towards +y; its eyes stay level.
struct Face {
  Eigen::Vector3d mouth = Eigen::Vector3d::Zero();  // [m] in the base frame
  double tilt_up = 0, tilt_side = 0;                // [rad]
};

/// How near a search comes to seeing a face, the best of its views: the later, the nearer.
enum class Sight { outside_pictures, at_wrong_depth, turned_away, seen };

/// What the cameras see from the search poses, by geometry alone. It asks of one view that the
/// square which the detector frames lies in both pictures, that the face is within the depths and
/// large enough, and that both cameras see it at no more than `max_face_angle_deg` from its normal.
/// Light, and whether the arm reaches the view, are not asked.
class SearchCoverage {
 public:
  /// None when the views are not known: the robot has no pointing axis, or the rig hangs on another
  /// link than the tool.
  static std::optional<SearchCoverage> make(const Parameters& parameters, const RobotModel& robot,
                                            const StereoRig& rig,
                                            const std::vector<ToolPose>& views);

  Sight sight_of(const Face& face) const;

  /// Over the faces that the lamp promises to find, an even grid of 6480.
  struct Shares {
    std::array<double, 4> of_sight{};  // by Sight; their sum is 1
    struct Region {
      std::string name;  // "high and turned up"
      double seen = 0;   // share of the faces in it
    };
    /// Where less than half is seen, the worst first: thirds of the height with thirds of the tilt
    /// up, thirds of the width with thirds of the turn aside.
    std::vector<Region> blind;
  };
  Shares shares() const;

  /// The same in two lines for the operator.
  std::vector<std::string> lines() const;

 private:
  struct Square;
  SearchCoverage(const Parameters& parameters, const StereoCamera& camera)
      : parameters_{parameters}, camera_{camera} {}
  Sight sight_from(const Eigen::Isometry3d& left_T_base, const Square& square) const;

  Parameters parameters_;
  StereoCamera camera_;
  std::vector<Eigen::Isometry3d> left_T_base_;  // of each view
};

}  // namespace armature::task::lamp_alignment
