// SPDX-License-Identifier: Apache-2.0
#include "topics/topics.hpp"

#include <fmt/format.h>
#include <stdio_ext.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "armature/bus/fast_dds/observer.hpp"
#include "armature/bus/topic_name.hpp"
#include "armature/config/problems.hpp"
#include "armature/messages/cdr_to_json.hpp"
#include "armature/messages/known_types.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
#include "exit_code.hpp"
#include "inspect/plugins.hpp"
#include "readable_json.hpp"
#include "topics/rate_meter.hpp"

namespace armature {
namespace {

constexpr Duration kDiscovery = seconds(1.5);
constexpr int kMinForARate = 2;

std::atomic<bool> g_interrupted{false};

/// Prints a line. When nobody reads it any more, as behind `| head -n 1`, the watch ends in order:
/// a process that is killed in the midst of DDS makes those wait that send to it.
void tell(const std::string& line) {
  const bool written = std::fputs((line + '\n').c_str(), stdout) >= 0;
  if (written && std::fflush(stdout) == 0) return;
  g_interrupted = true;
  if (errno != EPIPE) return;  // a full disk is told at the end
  __fpurge(stdout);
  std::clearerr(stdout);
}

/// Ends a watch: enough samples, the time is over, or the operator wants it.
class Finish {
 public:
  /// `least`: how many samples are of use when the options ask for no number.
  Finish(const TopicOptions& options, std::uint64_t least) : options_{options}, least_{least} {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) {
      std::signal(signal, [](int) { g_interrupted = true; });
    }
  }
  /// Counts a sample; true when it was the last one wanted.
  bool count() { return ++seen_ == options_.count; }
  std::uint64_t seen() const { return seen_; }
  /// kTimedOut, and a line that says so, when fewer samples than wanted came in the time given.
  int wait(const std::function<void()>& every_second = [] {}) {
    const auto start = std::chrono::steady_clock::now();
    auto tick = start;
    while (!g_interrupted && (options_.count == 0 || seen_ < options_.count)) {
      if (std::chrono::steady_clock::now() - tick >= std::chrono::seconds{1}) {
        tick += std::chrono::seconds{1};
        every_second();
      }
      const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
      if (options_.timeout_s > 0 && elapsed.count() > options_.timeout_s) {
        return options_.count > 0 || seen_ < least_ ? timed_out() : kOk;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds{20});
    }
    return kOk;
  }

 private:
  int timed_out() const {
    const std::uint64_t wanted = options_.count > 0 ? options_.count : least_;
    const std::string came =
        seen_ == 0 ? "no sample" : fmt::format("{} of {} samples", seen_.load(), wanted);
    fmt::print(stderr, "armature: {} of '{}' came within {:g} s\n", came, options_.topic,
               options_.timeout_s);
    return kTimedOut;
  }

  TopicOptions options_;
  std::uint64_t least_;
  std::atomic<std::uint64_t> seen_{0};
};

/// Makes the types of message libraries in the plugin path known here, by the text that they hold.
void describe_messages(const PluginRegistry& plugins) {
  std::vector<PluginRegistry::Messages> left = plugins.messages();
  for (std::size_t before = left.size() + 1; left.size() < before;) {  // one may nest another's
    before = left.size();
    std::erase_if(left, [](const auto& library) {
      return add_descriptions(library.idl, library.file.string()).has_value();
    });
  }
  for (const auto& [file, idl] : left) {
    fmt::print(stderr, "armature: its messages cannot be shown: {}\n",
               add_descriptions(idl, file.string()).error().text);
  }
}

PluginPtr<DdsObserver> observe(PluginRegistry& plugins, const TopicOptions& options) {
  tell_warnings(plugins);
  describe_messages(plugins);
  const ObserverOptions observer_options{.network = options.network,
                                         .asks_again = !options.best_effort};
  auto observer = plugins.make<DdsObserver>("observer/fast_dds", observer_options);
  if (!observer) throw PluginError(observer.error().text);
  return std::move(*observer);
}

/// kTimedOut, and a line that says so, when nothing was found in less time than discovery takes:
/// that says nothing of the domain. Else kOk.
int too_short(DdsObserver& observer, const TopicOptions& options) {
  const bool enough = options.timeout_s <= 0 || seconds(options.timeout_s) >= kDiscovery;
  if (enough || !observer.topics().empty()) return kOk;
  fmt::print(stderr,
             "armature: no topic of domain {} was found within {:g} s, which is too short to find "
             "out; give it {:g} s\n",
             options.network.domain, options.timeout_s, to_seconds(kDiscovery));
  return kTimedOut;
}

std::string no_topics(const TopicOptions& options) {
  const auto& [domain, interfaces, peers, server, shared_memory] = options.network;
  const bool elsewhere = !interfaces.empty() || !server.empty();
  return fmt::format("domain {} has no topics{}", domain,
                     elsewhere ? ""
                               : " on loopback; a deployment with `dds:` is heard by --interface, "
                                 "--peer or --discovery-server");
}

/// "; did you mean '/lamp/target'?" or "; topics that are there: ...", or that there are none.
std::string topics_there(DdsObserver& observer, const TopicOptions& options) {
  std::vector<std::string> names;
  for (const auto& topic : observer.topics()) {
    if (topic.writers > 0) names.push_back(ros_topic_name(topic.name));
  }
  if (names.empty()) return "; " + no_topics(options);
  const std::string hint = config::did_you_mean(options.topic, names);
  if (hint.find("did you mean") != std::string::npos) return hint;
  std::string list;
  for (const std::string& name : names) list += "\n  " + name;
  return "; topics that are there:" + list;
}

/// Watches a topic, and waits for one that nobody writes yet, which is said. kOk when it is watched
/// or was interrupted; kTimedOut, or an exception with what is there, when the time is over.
int watch(DdsObserver& observer, const TopicOptions& options,
          const std::function<void(const ObservedSample&)>& on_sample) {
  constexpr Duration kLook = seconds(0.1);  // Ctrl-C waits no longer
  const auto start = std::chrono::steady_clock::now();
  for (bool told = false; !g_interrupted;) {
    const auto watching = observer.watch(options.topic, kLook, on_sample);
    if (watching) return kOk;
    const Duration waited = std::chrono::steady_clock::now() - start;
    const bool may_come = watching.error().text.starts_with("nobody writes");
    const bool over = options.timeout_s > 0 && waited > seconds(options.timeout_s);
    if (over || !may_come) {
      if (const int code = too_short(observer, options); code != kOk) return code;
      throw std::runtime_error(watching.error().text + topics_there(observer, options));
    }
    if (told || options.timeout_s > 0 || waited < kDiscovery) continue;
    told = true;
    fmt::print(stderr, "armature: {} yet, waiting for it{}\n", watching.error().text,
               topics_there(observer, options));
  }
  return kOk;
}

std::string ros_type(const std::string& dds_name) {
  const TypeDescription* type = describe_type(dds_name);
  return type ? type->ros_name : dds_name;
}

std::string counted(int count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

}  // namespace

int list_topics(const TopicOptions& options) {
  PluginRegistry plugins;
  const auto observer = observe(plugins, options);
  std::this_thread::sleep_for(options.timeout_s > 0 ? seconds(options.timeout_s) : kDiscovery);
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  if (const int code = too_short(*observer, options); code != kOk) return code;
  const auto topics = observer->topics();
  if (topics.empty()) fmt::print(stderr, "armature: {}\n", no_topics(options));
  std::size_t width = 40;
  for (const auto& topic : topics) width = std::max(width, ros_topic_name(topic.name).size());
  for (const auto& topic : topics) {
    std::string types;
    for (const auto& type : topic.types) types += (types.empty() ? "" : ", ") + ros_type(type);
    if (options.json) {
      json.push_back({{"topic", ros_topic_name(topic.name)},
                      {"type", types},
                      {"writers", topic.writers},
                      {"readers", topic.readers},
                      {"deployments", topic.deployments}});
    } else {
      fmt::print("{:<{}} {:<32} {}, {} in other processes{}\n", ros_topic_name(topic.name), width,
                 types, counted(topic.writers, "writer"), counted(topic.readers, "reader"),
                 topic.types.size() > 1 ? "   CONFLICT: two types on one topic" : "");
    }
  }
  if (options.json) fmt::print("{}\n", json.dump());
  return kOk;
}

int echo_topic(const TopicOptions& options) {
  PluginRegistry plugins;
  Finish finish{options, 1};
  auto observer = observe(plugins, options);  // goes before what its callback uses
  const int watching = watch(*observer, options, [&](const ObservedSample& sample) {
    if (options.count > 0 && finish.seen() >= options.count) return;
    const TypeDescription* type = describe_type(sample.type);
    if (!type) {
      tell(
          fmt::format("{} bytes of {}; the folder of the library that has the type belongs into "
                      "ARMATURE_PLUGIN_PATH",
                      sample.cdr.size(), sample.type));
    } else {
      const auto json = cdr_to_json(*type, sample.cdr,
                                    options.full ? OctetArrays::whole : OctetArrays::shortened);
      if (!json) {
        fmt::print(stderr, "armature: not a {}: {}\n", type->ros_name, json.error().text);
      } else {
        tell(options.json ? json->dump() : readable(*json) + "\n---");
      }
    }
    finish.count();
  });
  return watching == kOk ? finish.wait() : watching;
}

namespace {

/// One line; `over` is "second" or "all".
void print_rate(const Rate& rate, const char* over, bool json) {
  if (json) {
    nlohmann::ordered_json line{{"over", over}, {"rate_hz", rate.hz()}, {"samples", rate.samples}};
    if (rate.intervals > 0) {
      line["shortest_s"] = to_seconds(rate.shortest);
      line["longest_s"] = to_seconds(rate.longest);
    }
    tell(line.dump());
  } else if (rate.intervals == 0) {
    tell("no samples");
  } else {
    tell(fmt::format("{:.1f} Hz over {} samples{}, intervals from {:.2f} to {:.2f} ms", rate.hz(),
                     rate.samples, std::string_view{over} == "all" ? " in all" : "",
                     to_seconds(rate.shortest) * 1e3, to_seconds(rate.longest) * 1e3));
  }
}

}  // namespace

int topic_rate(const TopicOptions& options) {
  PluginRegistry plugins;
  Finish finish{options, kMinForARate};
  std::mutex mutex;
  RateMeter meter;
  auto observer = observe(plugins, options);  // goes before what its callback uses
  const int watching = watch(*observer, options, [&](const ObservedSample& sample) {
    if (options.count > 0 && finish.seen() >= options.count) return;
    const std::scoped_lock lock{mutex};
    meter.add(sample.source);
    finish.count();
  });
  if (watching != kOk) return watching;
  const int code = finish.wait([&] {
    const std::scoped_lock lock{mutex};
    if (meter.all().samples > 0) print_rate(meter.take_recent(), "second", options.json);
  });
  const std::scoped_lock lock{mutex};
  if (meter.all().intervals == 0) {
    if (code != kOk) return code;
    throw std::runtime_error(
        fmt::format("interrupted before two samples of '{}' came", options.topic));
  }
  print_rate(meter.all(), "all", options.json);
  return code;
}

}  // namespace armature
