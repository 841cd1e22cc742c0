// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <string>

#include "armature/values/time.hpp"

namespace armature::report::lamp_alignment {

/// What there is to tell about a scenario that did not come to its end: what became of the last
/// face that was seen, and what the task was at.
class UnfinishedScenario {
 public:
  /// There is a face in the picture that was taken at `picture`.
  void see_face(Time picture);
  void see_estimate() { refusal_.clear(); }
  /// Why the picture gave no estimate; not told of a picture without a face.
  void see_refusal(Time picture, const std::string& why);
  /// `doing` is "searching 1/9", `why` that it does not go on, or "".
  void see_task(const std::string& doing, const std::string& why, Time now);

  /// "; the last that was seen was refused: ...; the task had been searching 1/9 for 3.2 s", or "".
  std::string told(Time now) const;

 private:
  std::deque<Time> faces_;
  std::string refusal_, doing_, why_;
  Time doing_since_;
};

}  // namespace armature::report::lamp_alignment
