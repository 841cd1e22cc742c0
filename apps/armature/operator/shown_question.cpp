// SPDX-License-Identifier: Apache-2.0
#include "operator/shown_question.hpp"

#include <fmt/format.h>

namespace armature {

void ShownQuestion::show(const std::string& step, Moment now) {
  if (step == step_) return;
  if (!step_.empty()) before_ = step_;
  step_ = step;
  since_ = now;
}

Expected<std::string> ShownQuestion::confirmed(Moment now) const {
  const bool is_another = !before_.empty() && before_ != step_;
  if (is_another && !step_.empty() && now - since_ < kReading) {
    return refuse(
        fmt::format("the question has just changed from '{}' to '{}', and nothing is "
                    "confirmed: say it again",
                    before_, step_));
  }
  return step_;
}

}  // namespace armature
