// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>

#include "armature/values/time.hpp"

namespace armature::report::lamp_alignment {

/// What there is to tell about a scenario that did not come to its end: what became of the faces
/// that were seen, and what the task was at.
class UnfinishedScenario {
 public:
  /// There is a face in the picture that was taken at `picture`.
  void see_face(Time picture);
  /// The code of its pose, by which refusals are told apart; before `see_refusal`.
  void see_code(Time picture, std::uint8_t code);
  void see_estimate() { refusals_.clear(); }
  /// Why the picture gave no estimate; not told of a picture without a face.
  void see_refusal(Time picture, const std::string& why);
  /// `doing` is "searching 1/9", `why` that it does not go on, or "".
  void see_task(const std::string& doing, const std::string& why, Time now);

  /// "; of 38 pictures of a face that were refused most (24) were so: ...; the task had been
  /// searching 1/9 for 3.2 s", or "". Refusals count from the last estimate.
  std::string told(Time now) const;

 private:
  struct Seen {
    Time picture;
    std::uint8_t code;
  };
  struct Refusals {
    int count = 0;
    std::string newest;
  };
  Seen* seen_at(Time picture);

  std::deque<Seen> faces_;
  std::map<std::uint8_t, Refusals> refusals_;
  std::string doing_, why_;
  Time doing_since_;
};

}  // namespace armature::report::lamp_alignment
