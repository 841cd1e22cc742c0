// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "armature/task/procedure.hpp"
#include "armature/task/pursued_goal.hpp"
#include "bottom_watch.hpp"
#include "calibration_run.hpp"
#include "drilling.hpp"
#include "error_forecast.hpp"
#include "sighting.hpp"
#include "task_implant_parameters.hpp"

namespace armature::task::implant {

/// What a registration answered.
struct RegisteredJaw {
  Eigen::Affine3d jaw_T_image = Eigen::Affine3d::Identity();
  double fiducial_error_m = 0;
  std::vector<RegisteredSite> sites;
};

/// The scenario of a drilling: the drill's tip is found (pivot), where tracker and body are
/// (hand-eye), how the image lies in the jaw (registration), where the jaw is (tracker), and then
/// the drill goes through all sites. Everything it knows comes in through the `see` and `hear`
/// calls.
class Implant {
 public:
  enum class Phase {
    pivoting,
    calibrating,
    registering,
    locating,
    approaching,
    drilling,
    drilled,
    going_back,  // out of the bone, to above the site
    aborting,    // to where the approach began
    aborted,
    refused
  };

  /// `flange_T_file_tool`: the drill as the robot file has it.
  Implant(const Parameters& parameters, const RobotModel& robot,
          const Eigen::Isometry3d& flange_T_file_tool);

  void begin(Time now);
  /// The sites of the plan: of the drill, in the image.
  void see_plan(const std::vector<ToolPose>& sites);
  /// Every sample of the arm.
  void see_arm(const Eigen::Isometry3d& base_T_flange);
  void see_pivot(const Sighting& sighting);
  void see_flange(const Sighting& sighting);
  void see_jaw(const Sighting& sighting);
  void see_registration(const RegisteredJaw& jaw, Time now);
  void see_refused_registration(const std::string& reason) { refuse(reason); }
  void hear(const GoalReport& report, Time now);
  Expected<void> hear(const OperatorCommand& command, Time now);
  void update(Time now);

  /// True as long as there is a plan to register and no answer.
  bool wants_registration() const { return phase_ == Phase::registering && !sites_.empty(); }
  std::optional<MotionGoal> outgoing_goal(Time now) { return goal_.outgoing(now); }

  Phase phase() const { return phase_; }
  const Procedure& procedure() const { return procedure_; }
  /// Where in the calibration it is, from 1.
  std::size_t calibration_pose() const { return static_cast<std::size_t>(calibration_.number()); }
  std::size_t calibration_poses() const { return static_cast<std::size_t>(calibration_.count()); }
  /// Why it does not go on, or "".
  const std::string& trouble() const { return trouble_; }
  /// What was found, each said once.
  std::vector<std::string> take_news();
  /// As far as it is known: complete from `approaching` on.
  const GuidedChain& chain() const { return chain_; }
  /// Of every site, from `approaching` on.
  const std::vector<ErrorForecast>& forecasts() const { return forecasts_; }

 private:
  void enter(Phase phase, Time now);
  enum class Step : std::size_t { pivot, calibration, registration, approach, first_site };
  void enter_step(Step step) { procedure_.enter(static_cast<std::size_t>(step)); }
  Expected<void> go_back(Time now);
  Expected<void> abort();
  void register_again(Time now);
  void come_to_bore(std::size_t bore, Time now);
  /// For the approach, or for the bore, once it may.
  void set_out();
  /// Once the arm rests.
  void turn_back();
  void come_back(Time now);
  void finish_pivot(Time now);
  void go_on_calibrating();
  void finish_calibration(Time now);
  void finish_locating(Time now);
  void go_on_drilling(Time now);
  /// How many samples are averaged before they are held against `max_jaw_motion_m`.
  int jaw_block() const;
  void locate_jaw(const Eigen::Isometry3d& tracker_T_jaw);
  void guard_jaw();
  /// By how much a jaw has moved [m] at the ends of the bores, where that is most.
  double max_moved(const Eigen::Isometry3d& tracker_T_jaw, const Eigen::Isometry3d& from) const;
  /// For good; an arm that is on its way holds.
  void refuse(const std::string& why);

  Parameters parameters_;
  Eigen::Isometry3d flange_T_file_tool_;
  Procedure procedure_;
  CalibrationRun calibration_;
  BodyWatch drill_watch_, flange_watch_, jaw_watch_;
  PursuedGoal goal_;
  int sent_to_ = 0;  // the calibration pose that goal_ is
  Phase phase_ = Phase::pivoting;
  std::vector<Eigen::Isometry3d> sites_;
  std::optional<Eigen::Isometry3d> base_T_flange_;
  std::vector<Eigen::Isometry3d> pivot_poses_;
  std::optional<Time> pivot_since_;
  Pivot pivot_;
  HandEye hand_eye_;
  PoseAverage jaw_, jaw_now_;
  std::optional<Eigen::Isometry3d> jaw_first_;  // the mean of the first samples of jaw_
  RegisteredJaw registered_;
  GuidedChain chain_;
  DrillingWay way_;
  std::optional<ToolPose> came_from_;  // where the approach began
  std::size_t bore_ = 0;               // of way_
  bool set_out_ = false;               // for the approach, or for the bore
  bool turned_ = false;                // going back or aborting: the way back is under way
  BottomWatch bottoms_;
  std::vector<ErrorForecast> forecasts_;
  std::vector<std::string> news_;
  std::string trouble_;
};

/// "pivoting", "calibrating", "registering", "locating", "approaching", "drilling", "drilled",
/// "going back", "aborting", "aborted", "refused".
const char* to_string(Implant::Phase phase);

}  // namespace armature::task::implant
