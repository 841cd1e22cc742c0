// SPDX-License-Identifier: Apache-2.0
#include "error_forecast.hpp"

#include <cmath>

namespace armature {

double ErrorForecast::rms_m() const {
  return std::hypot(std::hypot(registration.rms_m, hand_eye.rms_m),
                    std::hypot(tool.rms_m, tracker.rms_m));
}

double ErrorForecast::bound95_m() const {
  return std::hypot(std::hypot(registration.bound95_m, hand_eye.bound95_m),
                    std::hypot(tool.bound95_m, tracker.bound95_m));
}

/// The two halves of the hand-eye calibration both move the tip: where the tracker stands moves the
/// site, how the body sits on the flange moves the drill.
ErrorForecast forecast_at(const Eigen::Isometry3d& image_T_site, const GuidedChain& chain,
                          const Pivot& pivot, const HandEye& hand_eye, const PoseAverage& jaw,
                          const RegisteredSite& registered) {
  const Eigen::Vector3d patient_site = chain.patient_T_image * image_T_site.translation();
  const Eigen::Vector3d base_site = chain.base_T_site(image_T_site).translation();
  const Eigen::Vector3d flange_tip = chain.flange_T_tool().translation();
  const Eigen::Matrix3d base_R_flange = chain.base_T_flange(image_T_site).linear();
  ErrorForecast forecast;
  forecast.registration.rms_m = registered.error_rms_m;
  forecast.registration.bound95_m = registered.error_95_m;
  forecast.hand_eye = point_error(hand_eye.error_at(base_site).covariance +
                                  base_R_flange * hand_eye.body_error_at(flange_tip).covariance *
                                      base_R_flange.transpose());
  forecast.tool = pivot.tip_error;
  forecast.tracker = jaw.error_at(patient_site);
  return forecast;
}

}  // namespace armature
