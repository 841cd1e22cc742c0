// SPDX-License-Identifier: Apache-2.0
#include "operator/shown_question.hpp"

#include <fmt/format.h>

namespace armature {

void ShownQuestion::show(const std::string& step, Moment now) {
  if (step == step_) return;
  if (!step_.empty()) {
    before_ = step_;
    before_until_ = now;
  }
  step_ = step;
}

Expected<std::string> ShownQuestion::confirmed(Moment now) const {
  const bool has_taken_its_place = !before_.empty() && before_ != step_;
  if (has_taken_its_place && !step_.empty() && now - before_until_ < kReading) {
    return refuse(
        fmt::format("the question has just changed from '{}' to '{}', and nothing is "
                    "confirmed: say it again",
                    before_, step_));
  }
  return step_;
}

}  // namespace armature
