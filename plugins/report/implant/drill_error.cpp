// SPDX-License-Identifier: Apache-2.0
#include "drill_error.hpp"

namespace armature::report::implant {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Vector3d tip_error(const GuidedChain& estimate, const GuidedChain& truth,
                   const Isometry3d& image_T_site) {
  const Vector3d tip = estimate.base_T_flange(image_T_site) * truth.flange_T_tool().translation();
  return tip - truth.base_T_site(image_T_site).translation();
}

ErrorBudget error_budget(const GuidedChain& estimate, const GuidedChain& truth,
                         const Isometry3d& image_T_site) {
  GuidedChain registration = truth, hand_eye = truth, tool = truth, tracker = truth;
  registration.patient_T_image = estimate.patient_T_image;
  hand_eye.base_T_tracker = estimate.base_T_tracker;
  hand_eye.flange_T_body = estimate.flange_T_body;
  tool.tip = estimate.tip;
  tracker.tracker_T_patient = estimate.tracker_T_patient;
  return {.registration = tip_error(registration, truth, image_T_site),
          .hand_eye = tip_error(hand_eye, truth, image_T_site),
          .tool = tip_error(tool, truth, image_T_site),
          .tracker = tip_error(tracker, truth, image_T_site)};
}

}  // namespace armature::report::implant
