// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "armature/bus/fast_dds/observer.hpp"
#include "armature/bus/network.hpp"
#include "armature/messages/message_type.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"

namespace armature {

/// How a verb watches.
struct WatchOptions {
  NetworkOptions network;
  double timeout_s = 0;  // 0: never
  bool json = false;
};

/// How long it takes until whoever is in a domain is found.
inline constexpr Duration kDiscovery = seconds(1.5);

/// Whoever watches leaves in order from now on, on Ctrl-C, when the terminal is closed, and when
/// nobody reads what is printed: a process that is killed in the midst of DDS makes those wait that
/// send to it.
void leave_in_order();
/// It is time to leave.
bool left();
/// Waits; false as soon as it is time to leave.
bool wait_for(Duration time);
/// Prints a line, and leaves when nobody reads it any more, as behind `| head -n 1`.
void tell(const std::string& line);

/// A stranger in a DDS domain: reads, nothing else.
class Outsider {
 public:
  /// Throws PluginError when the domain cannot be joined.
  explicit Outsider(const WatchOptions& options, bool asks_again = true);

  DdsObserver& dds() { return *observer_; }
  /// Watches a topic, and waits for one that nobody writes yet, which is said. kOk when it is
  /// watched or it is time to leave; kTimedOut, or an exception with what is there, when the time
  /// is over. `on_sample` is called as DdsObserver::watch says; what it uses outlives this.
  int watch(const std::string& topic, const std::function<void(const ObservedSample&)>& on_sample);
  /// kTimedOut, and a line that says so, when nothing was found in less time than discovery takes:
  /// that says nothing of the domain. Else kOk.
  int too_short();
  /// That the domain has no topics, and what may be missing to hear them.
  std::string no_topics() const;

  /// "; did you mean '/lamp/target'?" or "; topics that are there: ...", or that there are none.
  std::string topics_there(const std::string& topic);

 private:
  WatchOptions options_;
  PluginRegistry plugins_;
  PluginPtr<DdsObserver> observer_;
};

/// What was sent; nothing when it is no message of this type.
template <class Message>
std::optional<Message> decoded(const ObservedSample& sample) {
  Message message;
  if (!message_type<Message>().decode(sample.cdr, &message)) return std::nullopt;
  return message;
}

}  // namespace armature
