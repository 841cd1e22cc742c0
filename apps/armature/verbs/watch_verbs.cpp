// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <limits>
#include <memory>

#include "topics/topics.hpp"
#include "verbs/option_checks.hpp"
#include "verbs/verbs.hpp"

namespace armature {

void add_topic_verbs(CLI::App& app, Action& action) {
  constexpr int kMaxSamples = std::numeric_limits<int>::max();
  CLI::App* topic = app.add_subcommand("topic", "Watch a running deployment over DDS");
  topic->require_subcommand(1);
  auto options = std::make_shared<TopicOptions>();
  const auto add_common = [&](CLI::App* verb) {
    verb->add_option("--domain", options->network.domain, "DDS domain")->check(CLI::Range(0, 232));
    add_network(*verb, options->network);
    verb->add_option("--timeout", options->timeout_s, "give up after this many seconds")
        ->check(not_positive);
    verb->add_flag("--json", options->json, "as JSON");
  };
  const auto add_best_effort = [&](CLI::App* verb) {
    verb->add_flag("--best-effort", options->best_effort,
                   "take samples as they come: one that was lost is not asked for again, and those "
                   "after it do not wait for it");
  };
  CLI::App* list = topic->add_subcommand("list", "Topics, types, and how many write and read them");
  add_common(list);
  list->callback([=, &action] { action = [=] { return list_topics(*options); }; });

  CLI::App* echo = topic->add_subcommand("echo", "Print the samples of a topic");
  echo->add_option("topic", options->topic, "e.g. /dental_lamp/arm/measured_js")->required();
  echo->add_option("-n,--count", options->count, "end after this many samples")
      ->check(CLI::Range(1, kMaxSamples));
  echo->add_flag("--full", options->full, "long byte arrays in full");
  add_best_effort(echo);
  add_common(echo);
  echo->callback([=, &action] { action = [=] { return echo_topic(*options); }; });

  CLI::App* hz = topic->add_subcommand("hz", "How often a topic is written");
  hz->add_option("topic", options->topic, "e.g. /dental_lamp/arm/measured_js")->required();
  hz->add_option("-n,--count", options->count, "end after this many samples, at least 2")
      ->check(CLI::Range(2, kMaxSamples));
  add_best_effort(hz);
  add_common(hz);
  hz->callback([=, &action] { action = [=] { return topic_rate(*options); }; });
}

}  // namespace armature
