// SPDX-License-Identifier: Apache-2.0
#include "watch/outsider.hpp"

#include <fmt/format.h>
#include <stdio_ext.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "armature/bus/topic_name.hpp"
#include "armature/config/problems.hpp"
#include "armature/runtime/plugins/described_messages.hpp"
#include "armature/values/monotonic_now.hpp"
#include "exit_code.hpp"
#include "inspect/plugins.hpp"
#include "standard_output.hpp"
#include "terminal_text.hpp"

namespace armature {
namespace {

std::atomic<bool> g_leaves{false};

}  // namespace

void leave_in_order() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) {
    std::signal(signal, [](int) { g_leaves = true; });
  }
}

bool left() { return g_leaves; }

bool wait_for(Duration time) {
  const Time end = monotonic_now() + time;
  while (!left() && monotonic_now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds{10});
  }
  return !left();
}

void tell(const std::string& line) {
  const bool written = std::fputs((line + '\n').c_str(), standard_output()) >= 0;
  if (written && std::fflush(standard_output()) == 0) return;
  g_leaves = true;
  if (errno != EPIPE) return;  // a full disk is told at the end
  __fpurge(standard_output());
  std::clearerr(standard_output());
}

Outsider::Outsider(const WatchOptions& options, bool asks_again) : options_{options} {
  tell_warnings(plugins_);
  for (const std::string& problem : describe_messages(plugins_)) {
    fmt::print(stderr, "armature: {}\n", problem);
  }
  auto observer = plugins_.make<DdsObserver>(
      "observer/fast_dds", ObserverOptions{.network = options.network, .asks_again = asks_again});
  if (!observer) throw PluginError(observer.error().text);
  observer_ = std::move(*observer);
}

int Outsider::too_short() {
  const bool enough = options_.timeout_s <= 0 || seconds(options_.timeout_s) >= kDiscovery;
  if (enough || !observer_->topics().empty()) return kOk;
  fmt::print(stderr,
             "armature: no topic of domain {} was found within {:g} s, which is too short to find "
             "out; give it {:g} s\n",
             options_.network.domain, options_.timeout_s, to_seconds(kDiscovery));
  return kTimedOut;
}

std::string Outsider::no_topics() const {
  const NetworkOptions& network = options_.network;
  const bool elsewhere = !network.interfaces.empty() || !network.discovery_server.empty();
  return fmt::format("domain {} has no topics{}", network.domain,
                     elsewhere ? ""
                               : " on loopback; a deployment with `dds:` is heard by --interface, "
                                 "--peer or --discovery-server");
}

std::string Outsider::topics_there(const std::string& topic) {
  std::vector<std::string> names;
  for (const auto& there : observer_->topics()) {
    if (there.writers > 0) names.push_back(terminal_text(ros_topic_name(there.name)));
  }
  if (names.empty()) return "; " + no_topics();
  if (std::string hint = config::spelling_hint(topic, names); !hint.empty()) return hint;
  std::string list;
  for (const std::string& name : names) list += "\n  " + name;
  return "; topics that are there:" + list;
}

int Outsider::watch(const std::string& topic,
                    const std::function<void(const ObservedSample&)>& on_sample) {
  constexpr Duration kFirstLook = seconds(0.1);  // Ctrl-C waits no longer
  const auto start = std::chrono::steady_clock::now();
  for (bool told = false; !left();) {
    const auto watching = observer_->watch(topic, kFirstLook, on_sample);
    if (watching) return kOk;
    const Duration waited = std::chrono::steady_clock::now() - start;
    const bool may_come = watching.error().text.starts_with("nobody writes");
    const bool over = options_.timeout_s > 0 && waited > seconds(options_.timeout_s);
    if (over || !may_come) {
      if (const int code = too_short(); code != kOk) return code;
      throw std::runtime_error(watching.error().text + topics_there(topic));
    }
    if (told || options_.timeout_s > 0 || waited < kDiscovery) continue;
    told = true;
    fmt::print(stderr, "armature: {} yet, waiting for it{}\n", watching.error().text,
               topics_there(topic));
  }
  return kOk;
}

}  // namespace armature
