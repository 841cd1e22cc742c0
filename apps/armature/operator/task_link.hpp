// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "armature/bus/topic.hpp"
#include "armature/bus/transport.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/runtime/execution/clock.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"

namespace armature {

/// Where a task is met: "/sr1_biopsy/task/operator", "/sr1_biopsy/task/state".
struct TaskTopics {
  std::string component, command, state;
};

/// A task of a running deployment, as an outsider meets it on DDS.
class TaskLink {
 public:
  /// Throws PluginError when the domain cannot be joined.
  TaskLink(PluginRegistry& plugins, const TaskTopics& topics, const NetworkOptions& network);

  /// What the task told last; nothing: it has told nothing yet.
  std::optional<msg::TaskState> state() const;
  /// Says a word, under a number that is told again until it is answered.
  void say(std::uint64_t id, const std::string& word, const std::string& step);

 private:
  SystemClock clock_;
  mutable std::mutex mutex_;
  std::optional<msg::TaskState> state_;
  PluginPtr<Transport> transport_;
  std::unique_ptr<Topic> command_;
  std::unique_ptr<RemoteReader> reader_;
};

}  // namespace armature
