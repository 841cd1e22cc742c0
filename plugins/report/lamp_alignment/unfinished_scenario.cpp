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
  faces_.push_back({picture, 0});
  if (faces_.size() > kPictures) faces_.pop_front();
}

UnfinishedScenario::Seen* UnfinishedScenario::seen_at(Time picture) {
  const auto seen = std::ranges::find(faces_, picture, &Seen::picture);
  return seen == faces_.end() ? nullptr : &*seen;
}

void UnfinishedScenario::see_code(Time picture, std::uint8_t code) {
  if (Seen* seen = seen_at(picture)) seen->code = code;
}

void UnfinishedScenario::see_refusal(Time picture, const std::string& why) {
  const Seen* seen = seen_at(picture);
  if (!seen) return;
  Refusals& like = refusals_[seen->code];
  ++like.count;
  like.newest = why;
}

void UnfinishedScenario::see_task(const std::string& doing, const std::string& why, Time now) {
  if (doing != doing_) doing_since_ = now;
  doing_ = doing;
  why_ = why;
}

std::string UnfinishedScenario::told(Time now) const {
  std::string text;
  int refused = 0;
  const Refusals* most = nullptr;
  for (const auto& [code, like] : refusals_) {
    refused += like.count;
    if (!most || like.count > most->count) most = &like;
  }
  if (refused == 1) text += "; a picture of a face was refused: " + most->newest;
  if (refused > 1) {
    text += fmt::format("; of {} pictures of a face that were refused most ({}) were so: {}",
                        refused, most->count, most->newest);
  }
  if (doing_.empty()) return text;
  text +=
      fmt::format("; the task had been {} for {:.1f} s", doing_, to_seconds(now - doing_since_));
  return why_.empty() ? text : text + ": " + why_;
}

}  // namespace armature::report::lamp_alignment
