// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "replay/message_difference.hpp"
#include "replay/recorded_run.hpp"
#include "replay/replayed_component.hpp"

namespace armature {

/// Whether a component does what was recorded of it.
class Repetition {
 public:
  /// The first call that did something else.
  struct Otherwise {
    std::uint64_t activation = 0;  // counts from 1
    std::string call = {};         // "step"
    double at_s = 0;               // since the recording began
    std::string topic = {};        // empty: it is none of its outputs
    std::string text = {};         // "position[2]: recorded 1, replayed 2, 45 ULP apart"
    std::optional<MessageDifference> field = {};
  };

  /// Holds the call that `component` has repeated last, its `activation`, to what `run` has of it.
  void hold(const msg::Activation& call, double at_s, std::uint64_t activation,
            const ReplayedComponent& component, const RecordedRun& run);

  const std::optional<Otherwise>& otherwise() const { return otherwise_; }
  /// Outputs that are as they were recorded.
  std::uint64_t outputs() const { return outputs_; }
  /// Outputs that cannot be held to the recording, which does not have them.
  std::uint64_t unrecorded() const { return unrecorded_; }

 private:
  /// Empty in all but `text`, or nothing where it did what was recorded.
  std::optional<Otherwise> other_output(const msg::Activation& call,
                                        const ReplayedComponent& component, const RecordedRun& run);

  std::optional<Otherwise> otherwise_;
  std::uint64_t outputs_ = 0, unrecorded_ = 0;
};

/// What a call said as it failed, in quotes, or that it did not: "it does not fail".
std::string failure_text(const std::string& failure);

/// "1,234,567".
std::string with_commas(std::uint64_t number);

}  // namespace armature
