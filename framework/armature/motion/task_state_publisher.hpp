// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/header.hpp"
#include "armature/runtime/component/setup.hpp"

namespace armature ARMATURE_EXPORT {

/// What a task is doing: "searching", 4 of 9; why it does not go on.
struct TaskReport {
  std::string state;
  std::size_t step = 0, steps = 0;
  std::string detail = {};

  /// What the operator reads: "refused: the markers lie nearly on one line".
  std::string line() const { return detail.empty() ? state : state + ": " + detail; }
};

/// The output `state` of a task: every change, and five times a second.
class TaskStatePublisher {
 public:
  explicit TaskStatePublisher(Setup& setup) : state_{setup.output<msg::TaskState>("state")} {}

  /// True when `line`, what the operator reads of it, is not the one before.
  bool publish(Time now, const TaskReport& report, const std::string& line) {
    constexpr Duration kPeriod = seconds(0.2);
    const bool changed = line != line_;
    if (!changed && now - published_ < kPeriod) return false;
    line_ = line;
    published_ = now;
    auto loan = state_.loan();
    write_header(loan->header_(), now);
    loan->state_() = report.state;
    loan->step_(static_cast<std::uint32_t>(report.step));
    loan->steps_(static_cast<std::uint32_t>(report.steps));
    loan->detail_() = report.detail;
    loan.publish();
    return changed;
  }

 private:
  Output<msg::TaskState> state_;
  std::string line_;
  Time published_;
};

}  // namespace armature
