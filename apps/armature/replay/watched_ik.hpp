// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "armature/kinds/ik/ik.hpp"
#include "armature/runtime/component/slot.hpp"

namespace armature {

/// What the calls of one inverse kinematics solver came to.
struct IkCalls {
  struct Call {
    std::string question;  // a line for `armature ik`
    std::string answer;    // "ok", "out_of_reach: 0.0341 m beyond reach"
    double took_s = 0;
  };
  std::uint64_t count = 0, failed = 0;
  double took_s = 0;
  std::optional<Call> slowest, first_failed;
};

/// Puts a watch around the solver in a slot of kind `ik`, which is asked as before; it counts into
/// `calls`, which outlives the slot. `plugin` is what sits there. From the component's next step
/// on. The reason is the solver's own, when it cannot be made a second time.
Expected<void> watch_ik(SlotPlace& slot, SlotPlugin plugin, IkCalls& calls);

}  // namespace armature
