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
#include "guidance.hpp"
#include "sighting.hpp"
#include "site_way.hpp"
#include "task_implant_parameters.hpp"
#include "thread_watch.hpp"

namespace armature::task::implant {

/// The scenario of a drilling: once it is known where everything is (guidance), the drill goes
/// through all sites and back to where it came from. Where the plan has implants, the driver that
/// holds them takes its place there and goes through them the same way. Everything it knows comes
/// in through the `see` and `hear` calls.
class Implant {
 public:
  enum class Phase {
    pivoting,
    calibrating,
    registering,
    locating,
    approaching,
    drilling,
    placing,
    withdrawing,    // to where the approach began
    changing_tool,  // the driver takes the place of the drill
    drilled,        // and out, with nothing to place
    placed,         // and out
    going_back,     // out of the bone, to above the site
    held,           // something is wrong while it is near the jaw: the operator leads it out
    aborting,       // to where the approach began
    aborted,
    refused
  };

  /// `flange_T_file_tool`: the drill as the robot file has it.
  Implant(const Parameters& parameters, const RobotModel& robot,
          const Eigen::Isometry3d& flange_T_file_tool);

  void begin(Time now);
  /// The sites of the plan, of the drill in the image, and an implant for each, or none.
  void see_plan(const std::vector<ToolPose>& sites,
                const std::vector<PlannedImplant>& implants = {});
  void see_refused_plan(const std::string& reason) { refuse(reason); }
  /// Every sample of the arm.
  void see_arm(const Eigen::Isometry3d& base_T_flange);
  /// How far the handpiece has turned [rad].
  void see_handpiece(double angle, Time now);
  void see_drill_in_hand(const Sighting& sighting);
  void see_driver_in_hand(const Sighting& sighting);
  void see_flange(const Sighting& sighting, Time now);
  void see_jaw(const Sighting& sighting);
  void see_registration(const RegisteredJaw& jaw, Time now);
  void see_refused_registration(const std::string& reason) { refuse(reason); }
  void hear(const GoalReport& report, Time now);
  Expected<void> hear(const OperatorCommand& command, Time now);
  void update(Time now);

  /// True as long as there is a plan to register and no answer.
  bool wants_registration() const {
    return phase_ == Phase::registering && !guidance_.sites().empty();
  }
  std::optional<MotionGoal> outgoing_goal(Time now) { return goal_.outgoing(now); }
  /// Into which an implant is being turned, or out of which, if any.
  const std::optional<Thread>& thread() const { return thread_watch_.thread(); }

  Phase phase() const { return phase_; }
  const Procedure& procedure() const { return procedure_; }
  /// Why it does not go on, or "".
  const std::string& trouble() const { return trouble_; }
  /// What was found, each said once.
  std::vector<std::string> take_news() { return guidance_.take_news(); }
  const Guidance& guidance() const { return guidance_; }

 private:
  /// The way of one tool through the sites.
  struct Round {
    SiteWay way;
    BottomWatch bottoms;
    std::size_t approach = 0;  // its step; the withdrawal is the last of its steps
    std::size_t withdrawal = 0;
  };

  /// The steps that are known before there is a way.
  enum Step : std::size_t { kPivot, kCalibration, kRegistration, kApproach };
  Expected<void> go_back(Time now);
  Expected<void> abort();
  void register_again(const std::string& why);
  void come_to_pass(std::size_t pass, Time now);
  /// For the approach, or for the pass, once it may.
  void set_out(Time now);
  /// Once the arm rests, or while it goes out.
  void turn_back();
  /// As slowly as the implant went in, to rest at the mouth of the bore, where its thread ends.
  void turn_out();
  void come_back(Time now);
  /// Over the sites to above the first, and then to where the approach began.
  void lead_out();
  /// Goes on with the guidance, to the step that it has come to.
  void find(Time now);
  void go_on_calibrating();
  void plan_rounds();
  void enter_approach(Time now);
  /// Of one that has moved nothing: where there is an operator, he is asked again.
  void refuse_approach(const std::string& why, Time now);
  /// The same of a site, or of a bore that an implant goes into.
  void ask_again(const std::string& why, Time now);
  void go_on(Time now);
  void finish_round(Time now);
  bool placing() const { return round_ == 1; }
  bool at_sites() const { return phase_ == Phase::drilling || phase_ == Phase::placing; }
  /// The jaw must be seen, and rest.
  bool watches_the_jaw() const { return phase_ == Phase::approaching || at_sites(); }
  /// The approach has moved the arm.
  bool under_way() const { return !goal_.left() && goal_.has_moved(); }
  /// The tool is not where the approach began any more.
  bool has_left() const;
  /// On its way there, or not out yet.
  bool near_the_jaw() const;
  const Pass& pass() const { return rounds_[round_].way.passes[pass_]; }
  /// The motion that begins the step in which the present one is.
  std::size_t first_of_step() const;
  Eigen::Vector3d tool() const { return (*base_T_flange_ * flange_T_file_tool_).translation(); }
  /// While nothing has set out yet an operator is asked again, about a new registration.
  void see_jaw_moved(const std::string& why);
  /// For good; an arm that is on its way holds. A tool that has set out towards the jaw is held
  /// where there is an operator, and he leads it out.
  void refuse(const std::string& why);

  Parameters parameters_;
  Eigen::Isometry3d flange_T_file_tool_;
  Procedure procedure_;
  Guidance guidance_;
  ThreadWatch thread_watch_;
  PursuedGoal goal_;
  int sent_to_ = 0;  // the calibration pose that goal_ is
  Phase phase_ = Phase::pivoting;
  std::optional<Eigen::Isometry3d> base_T_flange_;
  std::vector<Round> rounds_;
  std::optional<ToolPose> came_from_;  // where the approach began
  std::size_t round_ = 0, pass_ = 0;   // of rounds_, and of its way
  Time out_at_;                        // since then the drill is out, and may be changed
  bool homing_ = false;                // the way out leads straight to where the approach began
  bool led_out_anyhow_ = false;        // aborted while it was held, whatever the handpiece does
  std::string trouble_;
};

/// "pivoting", "calibrating", "registering", "locating", "approaching", "drilling", "placing",
/// "withdrawing", "changing tool", "drilled", "placed", "going back", "held", "aborting",
/// "aborted", "refused".
const char* to_string(Implant::Phase phase);

}  // namespace armature::task::implant
