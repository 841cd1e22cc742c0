// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
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
  /// Tells which of the two has changed in this activation.
  struct News {
    bool plan = false, registration = false;
  };

  RegisteredPlan(Input<Plan> plans, Input<msg::RegistrationRequest> questions,
                 Input<msg::RegistrationResponse> answers)
      : plans_{plans}, questions_{questions}, answers_{answers} {}

  /// Once an activation. The plan is the first one, until the task asks for the registration of
  /// another one: the task goes on with its own when others come.
  News read() {
    if (plans_.fresh()) remember(*plans_.latest(), last_plans_);
    if (questions_.fresh()) remember(*questions_.latest(), last_questions_);
    for (std::size_t i = 0; i < answers_.size(); ++i) {
      if (answers_[i].valid_()) remember(answers_[i], last_answers_);
    }
    News news{.plan = choose()};
    if (news.plan) news.registration = std::exchange(registration_, std::nullopt).has_value();
    hear([](const auto&) { return true; }, any_registration_);
    const auto is_own = [&](const auto& question) {
      return plan_ && is_asked_of(*plan_, question);
    };
    news.registration = hear(is_own, registration_) || news.registration;
    return news;
  }

  /// Null before the first one.
  const Plan* plan() const { return plan_ ? &*plan_ : nullptr; }
  /// The answer to the newest question about this plan that has one; null while there is none. It
  /// tells a registration.
  const msg::RegistrationResponse* registration() const {
    return registration_ ? &*registration_ : nullptr;
  }
  /// The same of whatever plan: `plan` may be the truth, which no task knows.
  const msg::RegistrationResponse* any_registration() const {
    return any_registration_ ? &*any_registration_ : nullptr;
  }

 private:
  /// An answer may take longer than it takes to ask again, and a question than its answer.
  template <class Message>
  static void remember(const Message& message, std::vector<Message>& last) {
    constexpr std::size_t kRemembered = 4;
    if (last.size() == kRemembered) last.erase(last.begin());
    last.push_back(message);
  }

  /// True when it is another one than before.
  bool choose() {
    if (!plan_ && !last_plans_.empty()) plan_ = last_plans_.front();
    if (!plan_ || last_questions_.empty()) return false;
    const auto is_asked = [&](const Plan& plan) {
      return is_asked_of(plan, last_questions_.back());
    };
    const auto asked = std::ranges::find_if(last_plans_, is_asked);
    if (is_asked(*plan_) || asked == last_plans_.end()) return false;
    plan_ = *asked;
    return true;
  }

  /// Keeps the answer to the newest of such questions; true when that is another one.
  template <class Is>
  bool hear(const Is& is_such, std::optional<msg::RegistrationResponse>& kept) const {
    for (const msg::RegistrationRequest& question : std::views::reverse(last_questions_)) {
      if (!is_such(question)) continue;
      for (const msg::RegistrationResponse& answer : std::views::reverse(last_answers_)) {
        if (answer.request_id_() != question.request_id_()) continue;
        if (kept == answer) return false;
        kept = answer;
        return true;
      }
    }
    return false;
  }

  std::optional<Plan> plan_;
  std::optional<msg::RegistrationResponse> registration_, any_registration_;
  std::vector<Plan> last_plans_;
  std::vector<msg::RegistrationRequest> last_questions_;
  std::vector<msg::RegistrationResponse> last_answers_;
  Input<Plan> plans_;
  Input<msg::RegistrationRequest> questions_;
  Input<msg::RegistrationResponse> answers_;
};

}  // namespace armature
