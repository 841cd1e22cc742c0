// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "armature/bus/qos.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
#include "bench/running_deployment.hpp"

namespace armature::bench {

class Asker;

/// A deployment of two components on executors of their own: one asks, the other answers every
/// question with a message of the same size.
class TopicExchange {
 public:
  enum class Part {
    both,    // in this process, executors on two processors
    asks,    // the other component is in another process,
    answers  // or this one
  };
  struct Settings {
    Part part = Part::both;
    int domain = 0;
    int ask_cpu = 0, answer_cpu = 1;
  };

  /// Throws what a deployment throws that cannot start. Runs from then on.
  explicit TopicExchange(const Settings& settings);
  /// Asks `count` times, each time in the step that the answer to the one before has activated.
  /// `bytes` is the size of the picture, which goes with `qos`: `state` or `sensor`. The times from
  /// publishing a question to the step that sees its answer [s]; none when they did not come within
  /// a second each.
  std::vector<double> round_trips(QosProfile qos, std::size_t bytes, int count);

 private:
  PluginRegistry plugins_;
  std::optional<RunningDeployment> running_;
  Asker* asker_ = nullptr;
};

}  // namespace armature::bench
