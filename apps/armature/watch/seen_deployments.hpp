// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "armature/messages/armature_msgs.hpp"
#include "watch/outsider.hpp"

namespace armature {

/// How a component last told that it is, and how often it ran between that and the time before.
struct SeenComponent {
  msg::ComponentState state;
  Time stamp;            // by the deployment's clock
  Time told;             // by the clock of the machine that it runs on
  Time heard;            // by the monotonic clock of this one
  double rate_hz = 0;    // activations in a second of the deployment's clock
  double processor = 0;  // share of one processor
};

/// What the processes of a running deployment tell of themselves.
struct SeenDeployment {
  std::map<std::string, msg::DeploymentDescription> processes;              // by name
  std::map<std::pair<std::string, std::string>, SeenComponent> components;  // by process and name

  /// The processes of which nothing was heard yet, or that have died.
  std::vector<std::string> missing() const;
  /// Whether all its processes have told what they consist of.
  bool is_whole() const { return !processes.empty() && missing().empty(); }
};

/// What a component told now, with the rates since `before`.
SeenComponent seen_after(const std::optional<SeenComponent>& before, SeenComponent now);

/// All deployments of a domain that tell of themselves, or the one of a name. Nobody else is
/// believed what he writes on their topics.
class SeenDeployments {
 public:
  /// `name`: empty for all of them.
  SeenDeployments(const WatchOptions& options, std::string name);

  /// Watches what came up since the last look, and forgets what has left.
  void look();
  std::map<std::string, SeenDeployment> all() const;
  /// Who writes there and is not believed, each once, in the order of coming.
  std::vector<std::string> notes() const;
  Outsider& outsider() { return outsider_; }

 private:
  struct OwnTopic {
    std::string deployment;
    bool describes = false;  // else it tells states
  };

  std::optional<OwnTopic> own_topic(const ObservedTopic& topic);
  void watch(const std::string& topic, const OwnTopic& own);
  void note(const std::string& who, const std::string& what);
  void add(const std::string& deployment, const msg::DeploymentDescription& description,
           const std::string& writer);
  void add(const std::string& deployment, const msg::ComponentStates& states, Time told);

  std::string name_;
  mutable std::mutex mutex_;
  std::map<std::string, SeenDeployment> seen_;
  std::set<std::string> noted_;  // who
  std::vector<std::string> notes_;
  std::set<std::string> watched_;  // topics
  Outsider outsider_;              // goes before what its callbacks use
};

}  // namespace armature
