// SPDX-License-Identifier: Apache-2.0
#include "image_in_base.hpp"

#include "armature/kinds/chain_messages.hpp"
#include "armature/kinds/registration_messages.hpp"

namespace armature::monitor::rviz {

void ImageInBase::hear(const msg::RegistrationResponse& registration) {
  const Eigen::Affine3d map = robot_T_image_of(registration);
  if (!map.matrix().allFinite()) return;
  robot_T_image_ = map;
  registered_to_base_ = registration.header_().frame_id_() == kBaseFrame;
}

void ImageInBase::hear(const msg::TFMessage& chain) {
  const auto links = chain_of(chain);
  if (!links) return;
  const Eigen::Isometry3d patient = links->base_T_tracker * links->tracker_T_patient;
  if (patient.matrix().allFinite()) base_T_patient_ = patient;
}

std::optional<Eigen::Affine3d> ImageInBase::base_T_image() const {
  if (!robot_T_image_ || registered_to_base_) return robot_T_image_;
  if (!base_T_patient_) return std::nullopt;
  return *base_T_patient_ * *robot_T_image_;
}

}  // namespace armature::monitor::rviz
