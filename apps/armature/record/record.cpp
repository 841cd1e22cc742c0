// SPDX-License-Identifier: Apache-2.0
#include "record/record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <system_error>

#include "armature/bus/topic_name.hpp"
#include "armature/config/problems.hpp"
#include "armature/messages/known_types.hpp"
#include "armature/recording/file_lock.hpp"
#include "armature/runtime/deployment_file/record_config.hpp"
#include "armature/values/json_text.hpp"
#include "armature/values/monotonic_now.hpp"
#include "exit_code.hpp"
#include "record/destination.hpp"
#include "record/recorder.hpp"
#include "shell_word.hpp"
#include "standard_output.hpp"

namespace armature {
namespace {

using Json = nlohmann::ordered_json;

/// `wanted` is the name of a topic as DDS has it, or as ROS 2 has it.
bool matches(const std::string& topic, const std::string& wanted) {
  return topic == wanted ||
         matches_topic(wanted.ends_with('*') ? wanted : ros_topic_name(dds_topic_name(wanted)),
                       topic);
}

/// Watches the wanted topics, those that come up later, too.
class Topics {
 public:
  Topics(const RecordOptions& options, Recorder& recorder)
      : options_{options}, recorder_{recorder}, outsider_{options} {}

  void look() {
    const std::vector<std::string> again = outsider_.dds().watch_again();
    for (const ObservedTopic& topic : outsider_.dds().topics()) {
      const std::string name = ros_topic_name(topic.name);
      if (watched_.contains(name)) {
        if (std::ranges::find(again, topic.name) != again.end()) {
          told_unheard_.erase(name);
          fmt::print(
              stderr,
              "armature: {} is written with another type or less QoS now: it is recorded anew "
              "from here on, and what was sent before that is missing\n",
              config::in_quotes(name));
        }
        tell_unheard(name, std::ranges::count_if(topic.endpoints, [](const auto& endpoint) {
                       return endpoint.writes && !endpoint.is_heard;
                     }));
        continue;
      }
      const bool is_wanted = options_.topics.empty() ||
                             std::ranges::any_of(options_.topics, [&](const std::string& wanted) {
                               return matches(name, wanted);
                             });
      if (topic.writers == 0 || !is_wanted) continue;
      const auto watching = outsider_.dds().watch(
          topic.name, Duration{0},
          [this, name](const ObservedSample& sample) { recorder_.add(name, sample); });
      if (!watching) continue;
      watched_.insert(name);
      if (!topic.types.empty()) tell_undescribed(name, topic.types.front());
    }
  }
  std::size_t count() const { return watched_.size(); }
  /// The names that were asked for and that nobody wrote.
  std::vector<std::string> missing() const {
    std::vector<std::string> missing;
    std::ranges::copy_if(options_.topics, std::back_inserter(missing), [&](const auto& wanted) {
      return std::ranges::none_of(
          watched_, [&](const std::string& watched) { return matches(watched, wanted); });
    });
    return missing;
  }

 private:
  /// Once for each type.
  void tell_undescribed(const std::string& name, const std::string& type) {
    if (describe_type(type) || !told_undescribed_.insert(type).second) return;
    fmt::print(stderr,
               "armature: {} is recorded without the definition of its type {}, so nobody can read "
               "it from the file: the folder of the library that has the type belongs into "
               "ARMATURE_PLUGIN_PATH\n",
               config::in_quotes(name), type);
  }

  /// Once for each topic.
  void tell_unheard(const std::string& name, std::ptrdiff_t writers) {
    if (writers == 0 || !told_unheard_.insert(name).second) return;
    fmt::print(stderr,
               "armature: {} of the writers of {} are not recorded: a topic is read with the type "
               "and the QoS of the writer that came first, and theirs do not match; give all of "
               "them the same ('armature topic info' shows them)\n",
               writers, config::in_quotes(name));
  }

  const RecordOptions& options_;
  Recorder& recorder_;
  std::set<std::string> watched_, told_unheard_, told_undescribed_;
  Outsider outsider_;  // goes before what its callbacks use
};

void tell_lost(const Recorder& recorder) {
  for (const auto& [topic, count] : recorder.dropped()) {
    fmt::print(stderr, "armature: {} samples of {} came faster than they could be written\n", count,
               config::in_quotes(topic));
  }
  for (const auto& [topic, count] : recorder.lost()) {
    fmt::print(stderr, "armature: {} samples of {} did not arrive\n", count,
               config::in_quotes(topic));
  }
}

}  // namespace

HeldFile hold_to_replace(const std::filesystem::path& file, bool may_be_replaced) {
  HeldFile held{nullptr, &std::fclose};
  std::error_code error;
  const bool has_content =
      std::filesystem::is_regular_file(file, error) && std::filesystem::file_size(file, error) > 0;
  if (!has_content) return held;
  if (!may_be_replaced) {
    throw InvalidChoice(fmt::format("'{}' is there already; --force replaces it", file.string()));
  }
  held.reset(std::fopen(file.c_str(), "re"));
  if (!held) {
    throw std::runtime_error(fmt::format("cannot replace '{}': {}", file.string(),
                                         std::generic_category().message(errno)));
  }
  lock_for_writing(fileno(held.get()), file);
  return held;
}

int record_topics(const RecordOptions& options) {
  leave_in_order();
  Destination destination{options.out, options.force};
  Recorder recorder{destination.path(), options.compress};
  if (destination.is_draft()) {
    fmt::print(stderr, "armature: '{}' stays until the new recording is whole; that is '{}'\n",
               options.out.string(), destination.path().string());
  }
  const Time start = monotonic_now();
  std::vector<std::string> missing;
  {
    Topics topics{options, recorder};
    bool told = false;
    while (!left() && recorder.problem().empty()) {
      topics.look();
      const Duration waited = monotonic_now() - start;
      if (options.timeout_s > 0 && waited > seconds(options.timeout_s)) break;
      if (!told && waited > kDiscovery && topics.count() == 0) {
        told = true;
        fmt::print(stderr, "armature: none of the topics is written in domain {} yet, waiting\n",
                   options.network.domain);
      }
      wait_for(seconds(0.05));
    }
    missing = topics.missing();
  }
  for (const std::string& topic : missing) {
    fmt::print(stderr, "armature: nobody wrote {}\n", config::in_quotes(topic));
  }
  tell_lost(recorder);
  try {
    recorder.close();
  } catch (const std::runtime_error& error) {
    if (!recorder.has_its_file()) throw;  // what has the name now is somebody else's
    if (recorder.messages() == 0) {
      destination.drop();
      throw;
    }
    throw std::runtime_error(
        fmt::format("{}; {} messages stand in the file and {} do not; those that do are readable, "
                    "and made whole by: armature record --repair {} -o whole.mcap",
                    error.what(), recorder.messages(), recorder.unwritten(),
                    shell_word(destination.path().string())));
  }
  const bool came = recorder.messages() > 0;
  came ? destination.take() : destination.drop();
  if (options.json) {
    std::uint64_t dropped = 0, lost = 0;
    for (const auto& [topic, count] : recorder.dropped()) dropped += count;
    for (const auto& [topic, count] : recorder.lost()) lost += count;
    print_out("{}\n", json_text(Json{{"file", options.out.string()},
                                     {"topics", recorder.topics()},
                                     {"messages", recorder.messages()},
                                     {"bytes", came ? recorder.bytes() : 0},
                                     {"dropped", dropped},
                                     {"lost", lost},
                                     {"head", came ? recorder.head() : ""}}));
  } else if (came) {
    print_out("{}: {} messages of {} topics, {}\n", options.out.string(), recorder.messages(),
              recorder.topics(), megabytes(recorder.bytes()));
    print_out("last hash {}\n", recorder.head());
  }
  if (came) return kOk;
  fmt::print(stderr, "armature: nothing came to be recorded: '{}' is {}\n", options.out.string(),
             destination.was_there() ? "as it was" : "not there");
  return kTimedOut;
}

}  // namespace armature
