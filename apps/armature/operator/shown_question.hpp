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
  /// A question that is younger has not been read: what is typed answers the one before.
  static constexpr std::chrono::milliseconds kReading{500};

  /// `step`: the step that is shown to wait for its confirmation; empty: none.
  void show(const std::string& step, Moment now);
  /// The step that a confirmation means; empty: none was asked about. Refused while the question
  /// has just taken the place of another one.
  Expected<std::string> confirmed(Moment now) const;

 private:
  std::string step_, before_;  // before_: the last step that was asked about, other than step_
  Moment before_until_{};
};

}  // namespace armature
