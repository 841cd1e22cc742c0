// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <ranges>
#include <utility>
#include <vector>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry_msgs.hpp"
#include "armature/runtime/component/ports.hpp"

namespace armature ARMATURE_EXPORT {

/// Whether a task that was given this plan asks that.
inline bool is_asked_of(const msg::NeedlePlan& plan, const msg::RegistrationRequest& request) {
  return plan.markers_() == request.image_markers_() &&
         request.targets_() == std::vector{plan.target_(), plan.entry_()};
}
inline bool is_asked_of(const msg::ImplantPlan& plan, const msg::RegistrationRequest& request) {
  return plan.markers_() == request.image_markers_() &&
         std::ranges::equal(plan.sites_(), request.targets_(), {},
                            [](const msg::Pose& site) { return site.position_(); });
}

/// A task's plan and how it is registered, for who only watches the task. Plan, question and answer
/// may come in any order: from another process they do.
template <class Plan>
class RegisteredPlan {
 public:
  /// What is not as it was.
  struct News {
    bool plan = false, registration = false;
  };

  RegisteredPlan(Input<Plan> plans, Input<msg::RegistrationRequest> questions,
                 Input<msg::RegistrationResponse> answers)
      : plans_{plans}, questions_{questions}, answers_{answers} {}

  /// Once an activation. The plan is the first one, until the task asks for the registration of
  /// another one: the task goes on with its own when others come.
  News read() {
    if (questions_.fresh()) remember(*questions_.latest(), last_questions_);
    bool again = false;
    for (std::size_t i = 0; i < answers_.size(); ++i) {
      if (!answers_[i].valid_()) continue;
      again = again || answers_[i].request_id_() == told_;
      remember(answers_[i], last_answers_);
    }
    const bool is_other = choose();
    const msg::RegistrationResponse* answer = registration();
    const auto id = answer ? std::optional{answer->request_id_()} : std::nullopt;
    return {is_other, std::exchange(told_, id) != id || again};
  }

  /// Null before the first one.
  const Plan* plan() const { return plan_ ? &*plan_ : nullptr; }
  /// The answer to the newest question about this plan that has one; null while there is none. It
  /// tells a registration.
  const msg::RegistrationResponse* registration() const {
    return answer_to([&](const auto& question) { return plan_ && is_asked_of(*plan_, question); });
  }
  /// The same of whatever plan: `plan` may be the truth, which no task knows.
  const msg::RegistrationResponse* any_registration() const {
    return answer_to([](const auto&) { return true; });
  }

 private:
  template <class Is>
  const msg::RegistrationResponse* answer_to(const Is& is_wanted) const {
    for (const msg::RegistrationRequest& question : std::views::reverse(last_questions_)) {
      if (!is_wanted(question)) continue;
      for (const msg::RegistrationResponse& answer : std::views::reverse(last_answers_)) {
        if (answer.request_id_() == question.request_id_()) return &answer;
      }
    }
    return nullptr;
  }

  /// An answer may take longer than it takes to ask again, and a question than its answer.
  template <class Message>
  static void remember(const Message& message, std::vector<Message>& last) {
    constexpr std::size_t kRemembered = 4;
    if (last.size() == kRemembered) last.erase(last.begin());
    last.push_back(message);
  }

  bool choose() {
    const Plan* newest = plans_.latest();
    if (!newest) return false;
    const bool is_asked = !last_questions_.empty() && is_asked_of(*newest, last_questions_.back());
    const bool is_other = plan_ && is_asked && !is_asked_of(*plan_, last_questions_.back());
    if (is_other || !plan_) plan_ = *newest;
    return is_other;
  }

  std::optional<Plan> plan_;
  std::vector<msg::RegistrationRequest> last_questions_;
  std::vector<msg::RegistrationResponse> last_answers_;
  std::optional<std::uint64_t> told_;  // the number of the registration
  Input<Plan> plans_;
  Input<msg::RegistrationRequest> questions_;
  Input<msg::RegistrationResponse> answers_;
};

}  // namespace armature
