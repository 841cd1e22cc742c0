// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>
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

/// The plan of a task, for who only watches it: the first one, until the task asks for the
/// registration of another one. The task goes on with its own when others come.
template <class Plan>
class PlanOfTask {
 public:
  PlanOfTask(Input<Plan> plans, Input<msg::RegistrationRequest> requests)
      : plans_{plans}, requests_{requests} {}

  /// True when it is another one than before; what was registered is not its.
  bool read() {
    const Plan* newest = plans_.latest();
    if (!newest) return false;
    const msg::RegistrationRequest* request = requests_.latest();
    const bool is_other =
        plan_ && request && is_asked_of(*newest, *request) && !is_asked_of(*plan_, *request);
    if (is_other || !plan_) plan_ = *newest;
    return is_other;
  }
  /// Null before the first one.
  const Plan* get() const { return plan_ ? &*plan_ : nullptr; }

 private:
  std::optional<Plan> plan_;
  Input<Plan> plans_;
  Input<msg::RegistrationRequest> requests_;
};

}  // namespace armature
