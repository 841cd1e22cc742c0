// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "armature/motion/pursued_goal.hpp"
#include "face_estimate.hpp"
#include "light_control.hpp"
#include "search_poses.hpp"

namespace armature {

struct AlignmentSettings {
  double distance_m = 0.5;  // of the lamp from the mouth, along the face normal
  SearchSettings search;
  int frames_per_view = 2;          // pictures without a face before the search goes on
  int settle_frames = 10;           // averaged at rest before an alignment is judged
  FaceBand settled;                 // an average this near to its goal is aligned
  FaceBand still;                   // while holding, an average within this band changes nothing
  FaceBand moved;                   // a few frames beyond this band: the patient moved
  int moved_frames = 3;             // so many
  double replan_interval_s = 0.25;  // between two goals while the patient moves
  double lost_s = 2.0;              // without a face at rest: search again
  LightSettings light;
};

/// One picture, as the landmark finder saw it.
struct Picture {
  Time stamp;
  bool face = false;
  double image_intensity = 0, face_intensity = 0;  // mean grey values
};

/// The behaviour of the lamp: check the light, search for a face, align with it, hold, follow.
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
    unreachable
  };

  explicit LampAlignment(const AlignmentSettings& settings);

  void see(const Picture& picture, Time now);
  void see(const FaceEstimate& estimate);
  /// Why a picture gave no estimate.
  void see_no_estimate(const std::string& why) { no_estimate_ = why; }
  void hear(const GoalReport& report, Time now) { goals_.hear(report, now); }
  void step(Time now);

  std::optional<MotionGoal> outgoing_goal(Time now) { return goals_.outgoing(now); }
  std::optional<double> take_light_level() { return std::exchange(new_level_, std::nullopt); }
  bool capture() const { return capture_; }

  Phase phase() const { return phase_; }
  std::size_t view() const { return views_looked_at_; }  // 1..9 while searching
  std::size_t views() const { return poses_.size(); }
  /// Why it does not go on, or "".
  const std::string& trouble() const { return trouble_; }

 private:
  using GoalState = PursuedGoal::State;

  void start_search(Time now);
  void search_for_lost_face(Time now);
  void next_view();
  void search(Time now);
  void leave_failed_view(Time now);
  void wait_for_a_view(Time now);
  void align_with(const FaceEstimate& estimate, Phase phase, Time now);
  void come_to_rest(Time now);
  void hold(Time now);
  void wait_for_another_face_position(Time now);
  bool follow_if_moved(Time now);
  bool lost(Time now) const;
  bool face_since(Time time) const { return latest_ && latest_->stamp >= time; }

  AlignmentSettings settings_;
  std::vector<ToolPose> poses_;
  LightControl light_;
  PursuedGoal goals_;
  FaceAverage at_rest_;  // estimates since the arm came to rest
  std::optional<FaceEstimate> latest_, goal_estimate_;
  std::size_t fresh_ = 0;  // estimates since the goal was set
  Phase phase_ = Phase::checking_light;
  bool capture_ = true;
  std::size_t pose_ = 0, views_looked_at_ = 0;
  std::size_t failed_views_ = 0;  // one after the other
  bool looking_ = false;
  Time looking_since_, goal_set_at_;
  int pictures_ = 0;  // in this view
  bool face_in_picture_ = false;
  std::optional<double> new_level_;
  std::string trouble_, no_estimate_;
};

/// "checking light", "searching", ...
const char* to_string(LampAlignment::Phase phase);

}  // namespace armature
