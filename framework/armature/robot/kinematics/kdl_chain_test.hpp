// SPDX-License-Identifier: Apache-2.0
// Arms as KDL chains, made without any of the robot models' kinematics: another's word for it.
#pragma once

#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <kdl/chain.hpp>
#include <string>
#include <vector>

#include "armature/robot/model/robot_model.hpp"

namespace armature::testing {

/// Denavit-Hartenberg rows by KDL's own functions.
inline KDL::Chain kdl_chain_of_rows(const RobotModel& model) {
  KDL::Chain chain;
  for (const Joint& row : model.joints()) {
    const KDL::Joint joint{row.type == Joint::Type::prismatic ? KDL::Joint::TransZ
                                                              : KDL::Joint::RotZ};
    if (model.convention() == RobotModel::Convention::standard) {
      chain.addSegment(KDL::Segment{joint, KDL::Frame::DH(row.a, row.alpha, row.d, row.theta)});
    } else {
      const auto before = KDL::Frame::DH_Craig1989(row.a, row.alpha, row.d, row.theta);
      chain.addSegment(KDL::Segment{KDL::Joint{KDL::Joint::None}, before});
      chain.addSegment(KDL::Segment{joint});
    }
  }
  return chain;
}

inline KDL::Frame kdl_frame(const urdf::Pose& pose) {
  const auto& r = pose.rotation;
  const auto& p = pose.position;
  return {KDL::Rotation::Quaternion(r.x, r.y, r.z, r.w), KDL::Vector{p.x, p.y, p.z}};
}

/// What lies between two links of a URDF file, as kdl_parser makes it.
inline KDL::Chain kdl_chain_of_urdf(const urdf::ModelInterface& model, const std::string& base,
                                    const std::string& tip) {
  std::vector<KDL::Segment> segments;
  for (auto link = model.getLink(tip); link->name != base; link = link->getParent()) {
    const urdf::Joint& joint = *link->parent_joint;
    const KDL::Frame origin = kdl_frame(joint.parent_to_joint_origin_transform);
    const KDL::Vector axis{joint.axis.x, joint.axis.y, joint.axis.z};
    const bool slides = joint.type == urdf::Joint::PRISMATIC;
    const auto type = slides ? KDL::Joint::TransAxis : KDL::Joint::RotAxis;
    segments.push_back(joint.type == urdf::Joint::FIXED
                           ? KDL::Segment{KDL::Joint{KDL::Joint::None}, origin}
                           : KDL::Segment{KDL::Joint{origin.p, origin.M * axis, type}, origin});
  }
  std::ranges::reverse(segments);
  KDL::Chain chain;
  for (const KDL::Segment& segment : segments) chain.addSegment(segment);
  return chain;
}

}  // namespace armature::testing
