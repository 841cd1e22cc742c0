// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "replay/recorded_run.hpp"
#include "replay/replayed_component.hpp"

namespace armature {

/// Whether a component that is constructed as it was recorded does what was recorded of it.
class Repetition {
 public:
  /// The first call that did something else.
  struct Otherwise {
    double at_s = 0;    // since the recording began
    std::string topic;  // empty: it is none of its outputs
    std::string text;   // "points[0].x: recorded 1, repeated 2"
  };

  /// Holds the call that `component` has repeated last to what `run` has of it.
  void hold(const msg::Activation& call, double at_s, const ReplayedComponent& component,
            const RecordedRun& run);

  const std::optional<Otherwise>& otherwise() const { return otherwise_; }
  /// Outputs that cannot be held to the recording, which does not have them.
  std::uint64_t unrecorded() const { return unrecorded_; }

 private:
  void hold_outputs(const msg::Activation& call, double at_s, const ReplayedComponent& component,
                    const RecordedRun& run);
  void note(double at_s, const std::string& topic, std::string text);

  std::optional<Otherwise> otherwise_;
  std::uint64_t unrecorded_ = 0;
};

/// What a call said as it failed, in quotes, or that it did not: "it does not fail".
std::string failure_text(const std::string& failure);

}  // namespace armature
