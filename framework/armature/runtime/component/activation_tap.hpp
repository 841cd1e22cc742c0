// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "armature/bus/sample.hpp"
#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// What of a component is called; armature_msgs/Activation says the same by number.
enum class ComponentCall : std::uint8_t { step, begin_stop, stop };

/// Is told everything that one component's calls depend on, and what they publish: a recording
/// keeps it, a replay answers from it. All functions are called on the thread of the call, between
/// `begin` and `end`; real-time safe but for a failure.
class ActivationTap {
 public:
  virtual ~ActivationTap() = default;
  virtual void begin(ComponentCall call, Time now) = 0;
  /// `failure`: what came out of the call as an exception, after which there is no other; or empty.
  virtual void end(std::string_view failure) = 0;
  /// What came for an input since the call before, oldest first; not called when nothing came.
  /// `input` counts from 0, in the order in which the component claims its inputs.
  virtual void read(int input, std::span<const SampleRef> samples) = 0;
  /// The component asks whether anybody reads an output; what it is told.
  virtual bool has_subscribers(bool truly) = 0;
  /// `sample` has its writer and sequence number. Other threads of the component call it, too.
  virtual void published(const SampleRef& sample) = 0;
};

}  // namespace armature
