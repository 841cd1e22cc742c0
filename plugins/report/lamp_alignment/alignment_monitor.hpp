// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "armature/values/time.hpp"
#include "face.hpp"
#include "report_lamp_alignment_parameters.hpp"

namespace armature::report::lamp_alignment {

/// How far the lamp is from where it should be.
struct LampError {
  double time_s = 0;  // since the start
  double distance_m = 0, direction_error_rad = 0;
  std::optional<double> distance_error_m;  // none: no goal has asked for a distance yet
  // Of the newest estimate of the face, which goes on with its rates as the truth does.
  std::optional<double> mouth_error_m, normal_error_rad;
};

/// How far the averaged estimate is from the truth.
struct EstimateError {
  Eigen::Vector3d mouth = Eigen::Vector3d::Zero();  // [m] in the base frame
  double normal_rad = 0;
};

/// One of the limits of "aligned" and what was measured against it.
struct AlignmentCheck {
  const char* name;  // of the report's parameter
  std::optional<double> value;
  double limit = 0;
  double unit = 1;  // of the parameter, in SI

  bool met() const { return value && *value <= limit; }
};

/// Holds the lamp against the truth. Time counts from the first `step`.
class AlignmentMonitor {
 public:
  explicit AlignmentMonitor(const Parameters& parameters) : parameters_{parameters} {}

  void see_truth(const TargetEstimate& truth, Time now);
  /// An estimate of a picture taken at its stamp.
  void see_estimate(const TargetEstimate& estimate, Time now);
  /// The lamp's centre and the way its light points, in the base frame, at `stamp`.
  void see_lamp(const Eigen::Vector3d& center, const Eigen::Vector3d& light, bool at_rest,
                Time stamp, Time now);
  /// A goal: where the lamp's centre shall be, and the mouth that it looks at from there.
  void see_goal(const Eigen::Vector3d& center, const Eigen::Vector3d& mouth) {
    asked_distance_m_ = (center - mouth).norm();
  }
  void see_task(bool holding) { holding_ = holding; }
  void see_new_goal() { replans_ += first_aligned_s_.has_value(); }
  void step(Time now);

  /// Told to the end: aligned (and again after the move), or no face found in time.
  bool finished() const;
  bool face_not_found() const { return not_found_; }
  /// What a scenario that has not ended still waits for.
  std::vector<std::string> missing() const;

  std::optional<double> time_to_find_s() const { return found_s_; }
  std::optional<double> time_to_align_s() const { return first_aligned_s_; }
  /// From the end of the patient's move, also of one that was over before the first alignment.
  std::optional<double> time_to_realign_s() const { return realigned_s_; }
  /// Of the mean of all estimates since the arm came to rest.
  std::optional<EstimateError> estimate_error() const;
  const std::vector<LampError>& lamp_errors() const { return lamp_errors_; }
  int replans() const { return replans_; }

 private:
  double since_start(Time time) const { return to_seconds(time - *start_); }
  void restart_average(Time now);
  std::array<AlignmentCheck, 2> lamp_checks() const;
  std::array<AlignmentCheck, 2> estimate_checks() const;

  Parameters parameters_;
  std::optional<Time> start_;
  std::optional<TargetEstimate> truth_, newest_;
  Face sum_;  // of the estimates since rest_since_
  int count_ = 0;
  std::optional<double> asked_distance_m_;
  Time rest_since_;
  bool holding_ = false, at_rest_ = false;
  std::vector<LampError> lamp_errors_;
  std::optional<Time> good_since_, moved_at_;  // moved_at_: when the truth changed last
  std::optional<double> found_s_, first_aligned_s_, realigned_s_;
  int replans_ = 0;
  bool not_found_ = false;
};

}  // namespace armature::report::lamp_alignment
