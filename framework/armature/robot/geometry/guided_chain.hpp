// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

namespace armature ARMATURE_EXPORT {

/// The frames between an arm's flange and a place in a patient's image, as a tracker ties them
/// together (Zhong et al. 2023: T_R_F = T_R_N T_N_M T_M_P T_P_implant T_F_D^-1). A chain of what
/// was calibrated says where the arm has to go, one of the truth where its tool then is.
struct GuidedChain {
  Eigen::Isometry3d base_T_tracker = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d flange_T_body = Eigen::Isometry3d::Identity();
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();  // [m] of the tool, in the body's frame
  Eigen::Quaterniond flange_R_tool = Eigen::Quaterniond::Identity();
  Eigen::Isometry3d tracker_T_patient = Eigen::Isometry3d::Identity();
  /// Rigid, or as free as the registration made it.
  Eigen::Affine3d patient_T_image = Eigen::Affine3d::Identity();

  Eigen::Isometry3d flange_T_tool() const {
    return Eigen::Translation3d{flange_T_body * tip} * flange_R_tool;
  }
  /// Where `image_T_site` is: its point by the whole map, its axes by the rotation in it.
  Eigen::Isometry3d base_T_site(const Eigen::Isometry3d& image_T_site) const {
    Eigen::Isometry3d patient_T_site = Eigen::Isometry3d::Identity();
    patient_T_site.translation() = patient_T_image * image_T_site.translation();
    patient_T_site.linear() = patient_T_image.rotation() * image_T_site.linear();
    return base_T_tracker * tracker_T_patient * patient_T_site;
  }
  /// Where the flange has to be for the tool to be at a site.
  Eigen::Isometry3d base_T_flange(const Eigen::Isometry3d& image_T_site) const {
    return base_T_site(image_T_site) * flange_T_tool().inverse();
  }
};

}  // namespace armature
