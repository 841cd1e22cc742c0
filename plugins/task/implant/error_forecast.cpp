// SPDX-License-Identifier: Apache-2.0
#include "error_forecast.hpp"

#include <cmath>

namespace armature::task::implant {

double ErrorForecast::rms_m() const {
  return std::hypot(std::hypot(registration.rms_m, hand_eye.rms_m),
                    std::hypot(tool.rms_m, tracker.rms_m));
}

double ErrorForecast::bound95_m() const {
  return std::hypot(std::hypot(registration.bound95_m, hand_eye.bound95_m),
                    std::hypot(tool.bound95_m, tracker.bound95_m));
}

ErrorForecast forecast_at(const Eigen::Isometry3d& image_T_site, const GuidedChain& chain,
                          const Pivot& pivot, const HandEye& hand_eye, const PoseAverage& jaw,
                          const RegisteredSite& registered) {
  const Eigen::Vector3d patient_site = chain.patient_T_image * image_T_site.translation();
  ErrorForecast forecast;
  forecast.registration.rms_m = registered.error_rms_m;
  forecast.registration.bound95_m = registered.error_95_m;
  forecast.hand_eye = hand_eye.guided_error_at(chain.flange_T_tool().translation(),
                                               chain.base_T_flange(image_T_site));
  forecast.tool = pivot.tip_error;
  forecast.tracker = jaw.error_at(patient_site);
  return forecast;
}

}  // namespace armature::task::implant
