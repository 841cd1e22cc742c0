// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <string>

#include "face_estimate.hpp"
#include "task_lamp_alignment_parameters.hpp"

namespace armature::task::lamp_alignment {

/// One picture, as the landmark finder saw it.
struct Picture {
  Time stamp;
  bool face = false;
  double image_intensity = 0, face_intensity = 0;  // mean grey values
};

/// What the face pose estimator says of a picture.
struct Verdict {
  Time stamp;
  std::string refusal = {};  // why there is no pose, or ""
  bool can_be_used = true;   // else the picture tells of no face, whether one is there or not
};

/// What the cameras say of the face: whether pictures come, whether one shows a face, and whether
/// an estimate of it is believed, which takes a few measurements, one after the other.
class FaceWatch {
 public:
  explicit FaceWatch(const Parameters& parameters) : parameters_{parameters} {}

  /// `now`: when the picture came.
  void see(const Picture& picture, Time now);
  /// True where it is a new measurement of a face that is confirmed, and where patients are. What
  /// is predicted over pictures without a measurement is none: `latest()` at a later time predicts
  /// better.
  bool see(const FaceEstimate& estimate);
  void see(const Verdict& verdict);
  /// Why a picture gave no estimate.
  void see_no_estimate(const std::string& why);

  /// The newest one that is believed, with rates that faces have.
  const std::optional<FaceEstimate>& latest() const { return latest_; }
  bool seen_since(Time time) const { return latest_ && latest_->stamp >= time; }
  /// It is no older than `lost_s`.
  bool is_fresh(Time now) const { return latest_ && !is_longer_than_lost(latest_->stamp, now); }
  /// Two estimates in a row say so.
  bool begins_to_move() const;
  /// It was lost, or jumped, since `know_it`, and was found again: it may be another one.
  bool is_found_anew() const { return is_found_anew_; }
  void know_it() { is_found_anew_ = false; }
  /// The newest estimate says so; all of the newest `settle_frames` do.
  bool is_still() const { return still_ > 0; }
  bool stays_still() const { return still_ >= parameters_.settle_frames; }

  /// No picture has come for `lost_s` after `since`, or none that can be used, and why; or "".
  std::string blindness(Time since, Time now) const;
  /// The newest picture that was judged cannot be used.
  bool is_unusable() const { return unusable_.has_value(); }
  /// The pictures have shown no face for `lost_s` after `since`. Where none come, or none that can
  /// be used, it is not lost.
  bool lost(Time since) const;
  /// Why a face that is in the pictures has not been believed for `lost_s` after `since`; or "".
  /// The reason is that of the newest picture with a face, or of the newest one that has any. A
  /// face that no picture has shown for `lost_s` is not in them.
  std::string disbelief(Time since) const;
  /// Why the newest picture with a face gave no estimate, or "".
  const std::string& refusal() const { return refusal_; }
  void forget_refusal() { refusal_.clear(); }
  /// Why the newest picture gave no estimate, or "".
  const std::string& no_estimate() const { return no_estimate_; }

 private:
  bool is_where_patients_are(const Eigen::Vector3d& mouth) const;
  bool is_longer_than_lost(Time since, Time now) const {
    return to_seconds(now - since) > parameters_.lost;
  }

  Time known_since(Time since) const { return latest_ ? std::max(latest_->stamp, since) : since; }

  Parameters parameters_;
  std::optional<FaceEstimate> latest_;
  int measurements_ = 0;      // of the newest estimate, confirmed or not
  bool begins_anew_ = false;  // the face that is measured, since `latest_`; not confirmed yet
  bool is_found_anew_ = false;
  bool is_no_patient_ = false;  // the face that is measured, by where it is
  int moving_ = 0, still_ = 0;  // estimates in a row that say so
  Time picture_at_, picture_came_;
  Duration period_{};  // between the newest two pictures
  Time face_at_;       // the newest picture with a face, believed or not, that may be a patient's
  Time begins_at_;     // the wait for one; pictures that cannot be used put it off
  bool face_ = false;  // in the newest picture
  struct Unusable {
    Time since;  // all pictures
    std::string why;
  };
  std::optional<Unusable> unusable_;
  std::string no_estimate_, refusal_;
};

}  // namespace armature::task::lamp_alignment
