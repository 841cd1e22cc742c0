// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "armature/calibration/hand_eye.hpp"
#include "armature/calibration/pivot.hpp"
#include "armature/robot/geometry/guided_chain.hpp"
#include "pose_average.hpp"

namespace armature::task::implant {

/// What the registration said of a site.
struct RegisteredSite {
  double error_rms_m = 0, error_95_m = 0;
};

/// How far off the drill's tip is likely to be at a site, by what each estimate of the chain brings
/// to it.
struct ErrorForecast {
  PointError registration, hand_eye, tool, tracker;

  double rms_m() const;
  /// 95 of 100 are nearer.
  double bound95_m() const;
};

ErrorForecast forecast_at(const Eigen::Isometry3d& image_T_site, const GuidedChain& chain,
                          const Pivot& pivot, const HandEye& hand_eye, const PoseAverage& jaw,
                          const RegisteredSite& registered);

}  // namespace armature::task::implant
