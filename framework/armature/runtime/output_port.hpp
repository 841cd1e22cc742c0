// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/bus/topic.hpp"
#include "armature/runtime/plugin_manifest.hpp"
#include "armature/values/time.hpp"

namespace armature {

/// When a published sample reaches its readers: at once, or later on the simulated clock.
class Delivery {
 public:
  virtual ~Delivery() = default;
  virtual void publish(Topic& topic, SampleRef sample) = 0;
};

/// One output of a component.
class OutputPort {
 public:
  OutputPort(PortSpec spec, Topic& topic, Delivery& delivery)
      : spec_{std::move(spec)}, topic_{&topic}, delivery_{&delivery} {}

  const PortSpec& spec() const { return spec_; }
  Topic& topic() { return *topic_; }
  bool wanted() const { return settings(spec_.qos).transient_local || topic_->has_readers(); }
  void publish(SampleRef sample) { delivery_->publish(*topic_, std::move(sample)); }

 private:
  PortSpec spec_;
  Topic* topic_;
  Delivery* delivery_;
};

}  // namespace armature
