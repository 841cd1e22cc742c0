// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "armature/robot/geometry/guided_chain.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "armature/values/expected.hpp"
#include "calibration_run.hpp"
#include "error_forecast.hpp"
#include "flange_place.hpp"
#include "jaw_place.hpp"
#include "pivot_run.hpp"
#include "sighting.hpp"
#include "site_way.hpp"
#include "task_implant_parameters.hpp"

namespace armature::task::implant {

/// What a registration answered.
struct RegisteredJaw {
  Eigen::Affine3d jaw_T_image = Eigen::Affine3d::Identity();
  double fiducial_error_m = 0;
  std::vector<RegisteredSite> sites;
};

/// Where the tools and the sites are, found step by step before a tool goes to the jaw: the tools'
/// tips (pivot), where tracker and body are (hand-eye), how the image lies in the jaw
/// (registration), and where the jaw is (tracker). Later it tells when the jaw moves or one of the
/// bodies is not seen any more. What is not good enough is answered with the reason.
class Guidance {
 public:
  enum class Step { pivot, hand_eye, registration, place, complete };

  Guidance(const Parameters& parameters, const RobotModel& robot,
           const Eigen::Matrix3d& flange_R_tool);

  void begin(Time now) { drill_.begin(now); }
  /// The sites of the plan, of the drill in the image, and an implant for each, or none. A plan
  /// after the first changes nothing.
  Expected<void> see_plan(const std::vector<ToolPose>& sites,
                          const std::vector<PlannedImplant>& implants);
  /// Every sample of the arm.
  void see_arm(const Eigen::Isometry3d& base_T_flange) { arm_noise_.see(base_T_flange); }
  /// A handpiece tells how far it turns.
  void see_handpiece() { has_handpiece_ = true; }
  void see_drill_in_hand(const Sighting& sighting);
  void see_driver_in_hand(const Sighting& sighting);
  /// With where the flange is as the arm says at `now`. It must be where the calibration has it
  /// while the jaw is located, and later where it `must_agree`: a tool is on its way.
  Expected<void> see_flange(const Sighting& sighting,
                            const std::optional<Eigen::Isometry3d>& base_T_flange, bool must_agree,
                            Time now);
  /// The jaw must not move while it is located, and later where it `must_rest`: a tool is on its
  /// way to it.
  Expected<void> see_jaw(const Sighting& sighting, bool must_rest);
  Expected<void> see_registration(const RegisteredJaw& jaw, Time now);
  /// Goes on to the next step where the present one is done.
  Expected<void> update(Time now);
  /// Back to the registration, with the calibrations as they are. `why` is told, or "".
  void register_again(const std::string& why);
  /// From now on the jaw and the flange have to be seen.
  void begin_to_guard(Time now);
  /// Which of them is not seen, and why.
  Expected<void> guard(Time now) const;

  Step step() const { return step_; }
  /// The poses that the hand-eye calibration visits.
  CalibrationRun& calibration() { return calibration_; }
  const CalibrationRun& calibration() const { return calibration_; }
  /// Each line once.
  std::vector<std::string> take_news();
  /// Of the plan, of the drill in the image.
  const std::vector<Eigen::Isometry3d>& sites() const { return sites_; }
  /// Of every site, or none.
  const std::vector<PlannedImplant>& implants() const { return implants_; }
  /// With the drill's tip; as far as it is known.
  const GuidedChain& chain() const { return chain_; }
  /// The same with the driver's, where there are implants.
  std::optional<GuidedChain> driver_chain() const;
  /// How well every site is known with the drill, once all is found.
  const std::vector<ErrorForecast>& forecasts() const { return forecasts_; }

 private:
  Expected<void> finish_pivot();
  Expected<void> finish_hand_eye();
  Expected<void> finish_place();
  /// Whether the body on the flange is where the calibration has it, at the drill's tip and, where
  /// the jaw has been located meanwhile, at the ends of the bores.
  Expected<void> check_flange(bool at_bores) const;
  int flange_samples() const;
  /// How well every site is known, for a tool whose tip was found so, or why that is not enough.
  Expected<std::vector<ErrorForecast>> forecast(const std::vector<GuidedChain>& chains,
                                                const Pivot& pivot, const char* tool);

  Parameters parameters_;
  Step step_ = Step::pivot;
  PivotRun drill_, driver_;
  CalibrationRun calibration_;
  BodyWatch flange_watch_, jaw_watch_;
  Eigen::Isometry3d flange_seen_at_ = Eigen::Isometry3d::Identity();  // by the arm, since it rests
  ArmNoise arm_noise_;
  Time moved_at_, restless_since_;  // the arm, by its own measurement
  bool has_handpiece_ = false;
  std::vector<Eigen::Isometry3d> sites_;
  std::vector<PlannedImplant> implants_;
  std::optional<Pivot> drill_tip_, driver_tip_;
  HandEye hand_eye_;
  RegisteredJaw registered_;
  JawPlace jaw_;
  FlangePlace flange_;
  GuidedChain chain_;
  std::vector<ErrorForecast> forecasts_;
  std::vector<std::string> news_;
};

}  // namespace armature::task::implant
