// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "armature/robot/model/robot_model.hpp"
#include "armature/task/procedure.hpp"
#include "armature/task/pursued_goal.hpp"
#include "needle_line.hpp"
#include "task_biopsy_parameters.hpp"
#include "touching.hpp"

namespace armature::task::biopsy {

/// What a registration answered.
struct RegisteredHead {
  Eigen::Affine3d robot_T_image = Eigen::Affine3d::Identity();
  double fiducial_error_m = 0;
  double target_error95_m = 0;
};

/// The scenario of one biopsy. Everything it knows comes in through the `see` and `hear` calls;
/// `update` decides. The needle goes along one planned way, which stops at the stand-off, at the
/// entry and at the target, and comes back along it.
class Biopsy {
 public:
  enum class Step : std::size_t { touching, registration, approach, entry, insertion, withdrawal };
  enum class Phase {
    waiting,      // for plan and markers, or to be given to a hand
    touching,     // an arm in a hand touches the markers
    registering,  // until the registration has answered
    asking,       // the operator is to confirm a step
    moving,       // towards the target
    at_target,
    withdrawing,
    going_back,  // one stop, since the operator wants it
    aborting,    // to where the way began
    held,        // it broke down on its way: the operator leads it back
    withdrawn,
    aborted,
    refused,
  };

  Biopsy(const Parameters& parameters, const RobotModel& robot);

  /// The plan on the image and where points were found before the robot are there.
  void see_head(const NeedleLine& plan, const std::vector<Eigen::Vector3d>& markers, Time now);
  void see_refused_plan(const std::string& reason) { refuse(reason); }
  /// Where the tip is [m], in the base frame: only where the markers are touched.
  void see_tip(const Eigen::Vector3d& tip, Time stamp) { touching_.see_tip(tip, stamp); }
  void see_registration(const RegisteredHead& head, Time now);
  void see_refused_registration(const std::string& reason, Time now) {
    if (wants_registration()) refuse_registration(reason, now);
  }
  void hear(const GoalReport& report, Time now);
  Expected<void> hear(const OperatorCommand& command, Time now);
  void update(Time now);

  /// True from the plan until the registration has answered.
  bool wants_registration() const {
    return has_plan_ && !line_ && step() == Step::registration && procedure_.may_act();
  }
  std::optional<MotionGoal> outgoing_goal(Time now) { return goal_.outgoing(now); }

  Phase phase() const;
  const Procedure& procedure() const { return procedure_; }
  const Touching& touching() const { return touching_; }
  /// Why it does not go on, or "".
  const std::string& trouble() const { return trouble_; }

 private:
  /// Where it goes, or will as soon as the arm rests; `held`: nowhere, it broke down on its way.
  /// What stands behind `onward` leads back.
  enum class Heading { none, held, onward, back, out, home };

  /// Every marker that is touched is a step of its own, behind the first one.
  Step step() const;
  void enter(Step step);
  std::vector<Procedure::Step> steps() const;
  void set_out();
  void arrive(Time now);
  /// The step that begins at a stop of the way: 0 is its start, `way_stops_` the target.
  Step step_from(int place) const;
  bool stands_where_it_began() const { return heading_ == Heading::none && place_ == 0; }
  /// The needle has left where the way began, and has not come back.
  bool has_set_out() const { return way_stops_ > 0 || goal_.has_moved(); }
  /// The step that was confirmed just now.
  Expected<void> begin_confirmed(Time now);
  Expected<void> go_back(Time now);
  Expected<void> abort();
  /// Along the way, once the arm rests.
  Expected<void> turn(Heading heading);
  void retrace(Heading heading);
  /// Ends a way that was not begun: the arm is where it would lead back to.
  void turn_at_once(Time now);
  /// A way that has not been begun is planned anew once the approach is confirmed again.
  void ask_again(Time now);
  void forget_line();
  void end_aborted();
  /// For good; or, where an operator is there, until he leads back a needle that has set out, or
  /// confirms again the approach of one that has not.
  void break_down(const std::string& why, Time now);
  void refuse(const std::string& why);

  // While a hand leads the arm: biopsy_in_hand.cpp.
  /// Nothing has been planned yet: a hand moves the arm, or may again.
  bool in_hand() const;
  /// A hand moves the arm now.
  bool led() const;
  void give_to_hand(Time now);
  /// The arm holds where it is, if it is in a hand.
  void take_from_hand();
  void touch_by_itself(Time now);
  /// The tip rests on the marker whose step it is; or why it does not.
  Expected<void> touch(Time now);
  /// The last place that was touched counts no more.
  void touch_again(Time now);
  /// The tip rests far from the head, so that the arm may move by itself; or why not.
  Expected<void> may_leave_hand(Time now) const;
  /// Takes the arm from the hand where it may leave it, and looks again once it holds: a hand may
  /// have moved it meanwhile. True when it may set out.
  bool has_left_hand(Time now);
  struct Wait {
    std::string what, last;  // for what, and why it was not so last
  };
  /// Not for ever.
  void wait_for_hand(const Wait& wait, Time now);
  /// Markers that were touched badly are touched again where somebody is there to do it.
  void refuse_registration(const std::string& why, Time now);

  Parameters parameters_;
  const RobotModel& robot_;
  Touching touching_;
  Procedure procedure_;
  NeedleLine plan_;
  bool has_plan_ = false;
  std::optional<NeedleLine> line_;  // before the robot
  PursuedGoal goal_;
  Heading heading_ = Heading::none;
  int way_stops_ = 0;  // 0: its first stop has not been reached yet
  int place_ = 0;      // the stop where the arm rests, or rested last
  Time at_target_since_;
  Time waits_since_;         // for a hand
  bool takes_back_ = false;  // the arm holds, or will, before it moves by itself
  Phase ended_as_ = Phase::withdrawn;
  std::string trouble_;
};

/// "waiting", "registering", "at target", ...
const char* to_string(Biopsy::Phase phase);

}  // namespace armature::task::biopsy
