// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <deque>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "armature/bus/topic.hpp"
#include "armature/bus/transport.hpp"
#include "armature/runtime/deployment_file/deployment_config.hpp"

namespace armature ARMATURE_EXPORT {

/// The processes that `process` exchanges topics with, by way of others, too.
std::set<std::string> processes_bound_to(const DeploymentConfig& deployment,
                                         const std::string& process);

/// The start of processes that no main process starts together. That one has met the others on its
/// topics does not mean that they have met it: its run could be over before they do, and they would
/// wait for ever. So each says when it has met all, and starts once the others have said so, too,
/// and have heard it. Not for several threads.
class CommonStart {
 public:
  /// Throws PluginError with the transport's reason. `transport` must outlive it.
  CommonStart(Transport& transport, const std::string& deployment, std::string process,
              const std::set<std::string>& others);
  CommonStart(const CommonStart&) = delete;
  CommonStart& operator=(const CommonStart&) = delete;

  /// Whether this process and the others have all said that they have met all. From then on a
  /// process that leaves, since its run is over, is not waited for. Before it, the word of one that
  /// leaves counts no more: one that takes its place has met nobody yet.
  bool all_have_met();
  /// Which process it waits for, now that this one has met the others on all of its topics, at
  /// `now`; nothing: it may start.
  std::optional<std::string> waiting(Time now);

 private:
  struct Other {
    explicit Other(std::string name) : process{std::move(name)} {}
    std::string process;
    std::atomic<bool> has_met{false};  // set on a DDS thread
    bool was_there = false;
    std::unique_ptr<RemoteReader> reader;
  };

  std::string process_;
  Topic topic_;
  RemoteWriter* writer_ = nullptr;  // the topic's
  bool is_told_ = false, all_have_met_ = false;
  int max_informed_ = 0;  // how many had met this one, since all have met
  std::deque<Other> others_;
};

}  // namespace armature
