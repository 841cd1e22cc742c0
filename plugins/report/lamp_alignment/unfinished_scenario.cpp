// SPDX-License-Identifier: Apache-2.0
#include "unfinished_scenario.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace armature::report::lamp_alignment {
namespace {

/// Of so many pictures it is remembered that there was a face: more than are ever under way.
constexpr std::size_t kPictures = 64;

}  // namespace

void UnfinishedScenario::see_face(Time picture) {
  faces_.push_back(picture);
  if (faces_.size() > kPictures) faces_.pop_front();
}

void UnfinishedScenario::see_refusal(Time picture, const std::string& why) {
  if (std::ranges::find(faces_, picture) != faces_.end()) refusal_ = why;
}

void UnfinishedScenario::see_task(const std::string& doing, const std::string& why, Time now) {
  if (doing != doing_) doing_since_ = now;
  doing_ = doing;
  why_ = why;
}

std::string UnfinishedScenario::told(Time now) const {
  std::string text;
  if (!refusal_.empty()) text += "; the last that was seen was refused: " + refusal_;
  if (doing_.empty()) return text;
  text +=
      fmt::format("; the task had been {} for {:.1f} s", doing_, to_seconds(now - doing_since_));
  return why_.empty() ? text : text + ": " + why_;
}

}  // namespace armature::report::lamp_alignment
