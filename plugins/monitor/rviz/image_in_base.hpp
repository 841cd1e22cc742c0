// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/tf2_msgs.hpp"

namespace armature::monitor::rviz {

/// Where the patient's image lies before the robot, as far as the topics tell: by a registration
/// whose markers were measured in the base frame, or by one in the frame of a tracked patient
/// together with the chain of calibrated frames that leads there.
class ImageInBase {
 public:
  /// An answer that tells a registration.
  void hear(const msg::RegistrationResponse& registration);
  /// It was of another plan.
  void forget_registration() { robot_T_image_.reset(); }
  /// The chain from base to tracker to patient; one that lacks a link is passed over.
  void hear(const msg::TFMessage& chain);

  /// None until the links are all told.
  std::optional<Eigen::Affine3d> base_T_image() const;
  /// Of the body on a tracked patient.
  const std::optional<Eigen::Isometry3d>& base_T_patient() const { return base_T_patient_; }

 private:
  bool registered_to_base_ = false;
  std::optional<Eigen::Affine3d> robot_T_image_;
  std::optional<Eigen::Isometry3d> base_T_patient_;
};

}  // namespace armature::monitor::rviz
