// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>

#include "armature/values/expected.hpp"

namespace armature {

/// The question that stands before an operator, and which step a word that is typed now confirms.
class ShownQuestion {
 public:
  using Moment = std::chrono::steady_clock::time_point;
  /// A question that is younger has not been read: what is typed answers the one before, which may
  /// have been gone for long.
  static constexpr std::chrono::milliseconds kReading{500};

  /// `step`: the step that is shown to wait for its confirmation; empty: none.
  void show(const std::string& step, Moment now);
  /// The step that a confirmation means; empty: none was asked about. Refused where the question
  /// has just come up, unless it is the first one or the same step asks again.
  Expected<std::string> confirmed(Moment now) const;

 private:
  std::string step_, before_;  // before_: the last step that was asked about, other than step_
  Moment since_{};             // step_ is shown
};

}  // namespace armature
