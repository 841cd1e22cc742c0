// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "armature/kinds/pose_messages.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/header.hpp"
#include "armature/messages/tf2_msgs.hpp"
#include "armature/robot/geometry/guided_chain.hpp"
#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {

/// What the second tool of a chain is called, where there is one.
inline constexpr std::string_view kDriver = "driver";

/// Adds where a tool is on the body of the flange.
inline void write_tool(const GuidedChain& chain, std::string_view tool, Time stamp,
                       msg::TFMessage& message) {
  auto& transform = message.transforms_().emplace_back();
  write_header(transform.header_(), stamp, "body");
  transform.child_frame_id_().assign(tool);
  assign(transform.transform_(), chain.flange_T_body.inverse() * chain.flange_T_tool());
}

/// The links of a guided chain, as ROS tells frames. Of a map that is not rigid the rotation only.
inline void write_chain(const GuidedChain& chain, Time stamp, msg::TFMessage& message) {
  message.transforms_().clear();
  const auto link = [&](std::string_view parent, std::string_view child,
                        const Eigen::Isometry3d& parent_T_child) {
    auto& transform = message.transforms_().emplace_back();
    write_header(transform.header_(), stamp, parent);
    transform.child_frame_id_().assign(child);
    assign(transform.transform_(), parent_T_child);
  };
  link(kBaseFrame, "tracker", chain.base_T_tracker);
  link("flange", "body", chain.flange_T_body);
  write_tool(chain, "tool", stamp, message);
  link("tracker", "patient", chain.tracker_T_patient);
  link("patient", "image",
       Eigen::Translation3d{chain.patient_T_image.translation()} *
           Eigen::Quaterniond{chain.patient_T_image.rotation()});
}

/// The chain of such a message, with that tool, or which link it lacks or is no pose.
inline Expected<GuidedChain> chain_of(const msg::TFMessage& message,
                                      std::string_view tool = "tool") {
  std::string wrong;
  const auto link = [&](std::string_view parent, std::string_view child) {
    const std::string name =
        "transform from '" + std::string{parent} + "' to '" + std::string{child} + "'";
    for (const auto& transform : message.transforms_()) {
      if (transform.header_().frame_id_() == parent && transform.child_frame_id_() == child) {
        const auto pose = pose_of(transform.transform_(), "the " + name + ": its");
        if (pose) return *pose;
        wrong = pose.error().text;
        return Eigen::Isometry3d::Identity();
      }
    }
    wrong = "no " + name;
    return Eigen::Isometry3d::Identity();
  };
  GuidedChain chain;
  chain.base_T_tracker = link(kBaseFrame, "tracker");
  chain.flange_T_body = link("flange", "body");
  const Eigen::Isometry3d body_T_tool = link("body", tool);
  chain.tip = body_T_tool.translation();
  chain.flange_R_tool = chain.flange_T_body.linear() * body_T_tool.linear();
  chain.tracker_T_patient = link("tracker", "patient");
  chain.patient_T_image = link("patient", "image");
  if (!wrong.empty()) return refuse(wrong);
  return chain;
}

}  // namespace armature
