// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "armature/bus/fast_dds/observer.hpp"
#include "armature/bus/topic.hpp"
#include "armature/bus/transport.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/runtime/execution/clock.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"

namespace armature {

/// Where a task is met: "/sr1_biopsy/task/operator", "/sr1_biopsy/task/state" of "sr1_biopsy".
struct TaskTopics {
  std::string deployment, component, command, state;
};

/// A task of a running deployment, as an outsider meets it on DDS. What it tells is taken from the
/// deployment's own writer; who else writes there is named on standard error.
class TaskLink {
 public:
  /// Throws PluginError when the domain cannot be joined.
  TaskLink(PluginRegistry& plugins, TaskTopics topics, const NetworkOptions& network);

  /// Looks who writes what the task tells; every now and then.
  void look();
  /// What the task told last; nothing: it has told nothing yet, or it is not sure who it is.
  std::optional<msg::TaskState> state() const;
  /// Who says that he is the task, as of the last look: one, when all is well.
  const std::vector<std::string>& tasks() const { return tasks_; }
  /// Everybody who is in the domain has been found.
  bool knows_all() const;
  /// The answer to the word that was said last, under whichever of the task's states it came: the
  /// next state may answer somebody else. Nothing: it has not been answered.
  std::optional<std::string> answer() const;
  /// Says a word, under a number that is told again until it is answered. It is stamped by the
  /// task's clock, as of what the task told last: the clock of this host may be another one.
  void say(std::uint64_t id, const std::string& word, const std::string& step);

 private:
  using WriterId = std::array<std::uint8_t, 16>;
  struct Told {
    msg::TaskState state;
    Duration clock_ahead{0};  // the task's, of ours
  };

  bool is_own(const ObservedEndpoint& writer);
  void keep(const ObservedSample& sample);
  const Told* told_last() const;
  void name_once(const std::string& who, const std::string& what);

  const TaskTopics topics_;
  SystemClock clock_;
  const Time joined_;
  std::vector<std::string> tasks_;
  std::set<std::string> named_;
  bool watched_ = false;
  mutable std::mutex mutex_;
  std::vector<WriterId> own_;
  std::map<WriterId, Told> states_;
  std::optional<std::uint64_t> said_;  // the number of the last word
  std::optional<std::string> answer_;
  PluginPtr<Transport> transport_;
  std::unique_ptr<Topic> command_;
  PluginPtr<DdsObserver> observer_;  // goes before what its callback uses
};

}  // namespace armature
