// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "armature/task/procedure.hpp"
#include "armature/task/pursued_goal.hpp"
#include "face_estimate.hpp"
#include "face_watch.hpp"
#include "light_control.hpp"
#include "search_poses.hpp"
#include "task_lamp_alignment_parameters.hpp"

namespace armature::task::lamp_alignment {

/// The behaviour of the lamp: check the light, search for a face, align with it, hold, follow. Its
/// steps are the light, the search and the alignment; following is part of the last one.
/// Everything it knows comes in through the `see` and `hear` calls; `step` decides.
class LampAlignment {
 public:
  enum class Phase {
    checking_light,
    searching,
    no_view,  // every search pose failed: looks from where it is
    aligning,
    holding,
    following,
    unreachable,
    aborting,  // back to the view from which it came
    aborted
  };

  /// `joint_6_to_lamp` in m: as of search_poses.
  LampAlignment(const Parameters& parameters, double joint_6_to_lamp);

  void see(const Picture& picture, Time now);
  void see(const FaceEstimate& estimate);
  void see(const Verdict& verdict);
  /// Why a picture gave no estimate.
  void see_no_estimate(const std::string& why) { face_.see_no_estimate(why); }
  void hear(const GoalReport& report, Time now) { goals_.hear(report, now); }
  Expected<void> hear(const OperatorCommand& command, Time now);
  void step(Time now);

  /// None to a face that is seen no more, however late the motion would take it.
  std::optional<MotionGoal> outgoing_goal(Time now);
  std::optional<double> take_light_level() { return std::exchange(new_level_, std::nullopt); }
  bool capture() const { return capture_; }

  Phase phase() const { return phase_; }
  const Procedure& procedure() const { return procedure_; }
  std::size_t view() const { return views_looked_at_; }  // 1..9 while searching
  std::size_t views() const { return poses_.size(); }
  /// Why it does not go on, or what it cannot mend, or "".
  std::string trouble() const;

 private:
  using GoalState = PursuedGoal::State;
  enum class Step : std::size_t { light, search, alignment };

  Step step() const { return static_cast<Step>(procedure_.step()); }
  /// The newest estimate may be set out for: it is no older than `lost_s`, and the lamp not blind.
  bool is_fresh(Time now) const { return blindness_.empty() && face_.is_fresh(now); }
  /// A face is what it is about, and none is searched for.
  bool is_at_a_face() const { return phase_ >= Phase::aligning && phase_ <= Phase::unreachable; }
  /// Whether the arm may set out to align with a face that is seen; asks the operator if need be,
  /// and anew where that face is elsewhere by then.
  bool may_align(Time now);
  /// The newest face is so far from `before` that it may be another one.
  bool is_elsewhere(const FaceEstimate& before) const;
  void ask_whose_face(const FaceEstimate& before, Time now);
  /// The face that it is about was found anew, elsewhere: it stops, and asks.
  bool leaves_face_found_elsewhere(Time now);
  /// A face has been seen since it looks, and is not lost again: it aligns with that one, or asks.
  /// Of one that is lost it asks no more, and is back in `before`.
  bool aligns_with_seen_face(Step before, Time now);
  Expected<void> may_resume(Time now) const;
  Expected<void> go_back(Time now);
  Expected<void> abort();
  void end_abort();
  void start_search(Time now);
  /// To the first view, once it may.
  void set_out();
  void search_for_lost_face(Time now);
  void next_view();
  void search(Time now);
  std::string reason_to_leave();
  /// Why the goal has failed; behind a stop and a rearm, what it waits for.
  std::string failure(const char* goes_on_for) const;
  void leave_failed_view(Time now);
  void wait_for_a_view(Time now);
  void align_with(const FaceEstimate& estimate, Phase phase, Time now);
  void come_to_rest(Time now);
  void hold(Time now);
  void wait_for_another_face_position(Time now);
  void follow_if_moved(Time now);
  /// Each of the newest `moved_frames` estimates says that the face is elsewhere than the goal has
  /// it. One alone that disagrees with the others moves nothing.
  bool has_moved() const;
  /// Whether the patient has begun to move, and the lamp is near enough to go with him.
  bool may_go_along() const;
  void go_along(Time now);
  void end_going_along(Time now);
  /// At rest before a face, or where one should be.
  bool lost() const;
  const FaceEstimate& latest() const { return *face_.latest(); }
  /// Where the newest `moved_frames` estimates have the face.
  FaceEstimate recent() const { return recent_.median(few_); }

  Parameters parameters_;
  std::size_t few_;  // moved_frames
  Procedure procedure_;
  FaceBand settled_, replan_, moved_;
  std::vector<ToolPose> poses_;
  LightControl light_;
  FaceWatch face_;
  PursuedGoal goals_;
  FaceAverage at_rest_;  // estimates since the arm came to rest
  std::optional<FaceEstimate> goal_estimate_;
  std::optional<FaceEstimate> asked_about_;  // by the alignment's question
  std::optional<Time> asked_whose_at_;       // when that came to be about another face
  FaceAverage recent_;       // estimates since the goal was set, the newest moved_frames
  bool goes_along_ = false;  // with the patient, in tracking mode
  Phase phase_ = Phase::checking_light;
  bool capture_ = true;
  std::optional<Time> captures_since_;
  std::size_t pose_ = 0, views_looked_at_ = 0;
  std::size_t failed_views_ = 0;             // one after the other
  std::vector<std::string> faceless_;        // why views of this round showed no face, each once
  bool looking_ = false, sets_out_ = false;  // to the first view of a search
  Time looking_since_, goal_set_at_;
  int refused_ = 0;               // goals in a row, on the way to a face
  int pictures_ = 0;              // in this view
  bool face_in_picture_ = false;  // in one of them
  std::optional<double> new_level_;
  std::string blindness_, trouble_, light_trouble_;
  std::string refusal_;  // of the last goal to a face that failed
};

/// "checking light", "searching", ...
const char* to_string(LampAlignment::Phase phase);

}  // namespace armature::task::lamp_alignment
