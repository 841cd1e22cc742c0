// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "armature/recording/recorded_processes.hpp"
#include "armature/runtime/plugins/running_component.hpp"
#include "armature/values/json_text.hpp"
#include "exit_code.hpp"
#include "replay/comparison.hpp"
#include "replay/recorded_text.hpp"
#include "replay/replay.hpp"
#include "shell_word.hpp"
#include "standard_output.hpp"
#include "terminal_text.hpp"

namespace armature {
namespace {

using Json = nlohmann::ordered_json;

std::string line_for(const IkCalls::Call& call, const ComparedSide::Solver& solver) {
  return fmt::format("echo {} | armature ik --robot {} --plugin {}{}", shell_word(call.question),
                     shell_word(solver.robot), solver.plugin,
                     solver.params.empty() ? "" : " --params " + shell_word(solver.params));
}

TimingFigures times_of(const ComparedSide& side, const std::string& component) {
  const auto& entry = side.process.entries().at(component);
  return entry.component->runner().times().duration.counts().figures();
}

bool is_same(const TopicDifferences& differences) {
  return differences.differing() + differences.only_before() + differences.only_now() == 0;
}

/// "by up to 0.25", or "first 0 now 7 in data[399]".
std::string text_of(const FieldDifferences& field) {
  if (field.is_number) return fmt::format("by up to {:.3g}", field.largest);
  const bool is_element = field.element.find('[') != std::string::npos;
  return fmt::format("first {} now {}{}", field.before, field.now,
                     is_element ? " in " + field.element : "");
}

void print_fields(const std::string& topic, const TopicDifferences& differences) {
  print_recorded("  {}: {} of {} messages differ\n", topic, differences.differing(),
                 differences.messages());
  if (differences.only_before() + differences.only_now() > 0) {
    print_recorded("    {} messages only in the recording, {} only now\n",
                   differences.only_before(), differences.only_now());
  }
  for (const auto& [name, field] : differences.fields()) {
    print_recorded("    {:<28} {:>6} of them, {} at {:.3f} s\n", name, field.messages,
                   text_of(field), field.at_s);
  }
  const auto& steps = differences.joint_steps();
  if (steps[0] + steps[1] > 0) {
    print_recorded("    largest step of a joint      recorded {:.6g}, now {:.6g}\n", steps[0],
                   steps[1]);
  }
}

void print_solver(const ComparedSide::Solver& before, const ComparedSide::Solver& now) {
  print_recorded("inverse kinematics of '{}': {} calls of {}, {} failed; {} of {}, {} failed\n",
                 now.component, before.calls.count, before.plugin, before.calls.failed,
                 now.calls.count, now.plugin, now.calls.failed);
  if (now.calls.count > 0 && before.calls.count > 0) {
    const double mean = now.calls.took_s / static_cast<double>(now.calls.count);
    const double mean_before = before.calls.took_s / static_cast<double>(before.calls.count);
    print_recorded("  a call takes {:.3g} times as long: {:.2f} us instead of {:.2f} us\n",
                   mean / mean_before, 1e6 * mean, 1e6 * mean_before);
  }
  if (now.calls.first_failed) {
    print_recorded("  first failure, {}:\n  {}\n", now.calls.first_failed->answer,
                   line_for(*now.calls.first_failed, now));
  }
  if (now.calls.slowest) {
    print_recorded("  slowest call, {:.2f} us, {}:\n  {}\n", 1e6 * now.calls.slowest->took_s,
                   now.calls.slowest->answer, line_for(*now.calls.slowest, now));
  }
}

void print_failure(const std::string& component, const OtherFailure& failure) {
  print_recorded("  at {:.3f} s, '{}': recorded {}, now {}\n", failure.at_s, component,
                 failure_text(failure.recorded), failure_text(failure.now));
}

void print_repetition(const std::string& component, const Repetition& repetition) {
  if (const auto& otherwise = repetition.otherwise()) {
    print_recorded(
        "'{}' does not repeat what was recorded (first at {:.3f} s): its differences are not those "
        "of the change only\n  {}{}{}\n",
        component, otherwise->at_s, otherwise->topic, otherwise->topic.empty() ? "" : ", ",
        otherwise->text);
  }
  if (repetition.unrecorded() > 0) {
    print_recorded("not compared with the recording: {} outputs of '{}', which are not in it\n",
                   repetition.unrecorded(), component);
  }
}

void print(const Comparison& comparison) {
  for (const auto& [name, compared] : comparison.components()) {
    const TimingFigures before = times_of(comparison.before(), name);
    const TimingFigures now = times_of(comparison.now(), name);
    print_recorded(
        "'{}', {} activations: a step takes {:.3g} times as long (p50 {:.2f} us instead of "
        "{:.2f}, p99 {:.2f} us instead of {:.2f}), the slowest {:.2f} us at {:.3f} s\n",
        name, now.count, now.p50_s / before.p50_s, 1e6 * now.p50_s, 1e6 * before.p50_s,
        1e6 * now.p99_s, 1e6 * before.p99_s, 1e6 * now.max_s, *compared.slowest_at_s);
    std::string same;
    for (const auto& [topic, differences] : compared.topics) {
      if (is_same(differences)) {
        same += (same.empty() ? "" : ", ") + topic;
      } else {
        print_fields(topic, differences);
      }
    }
    if (!same.empty()) print_recorded("  the same to the last bit: {}\n", same);
    if (compared.failure) print_failure(name, *compared.failure);
    print_repetition(name, comparison.repetition(name));
  }
  const auto& before = comparison.before().solvers;
  const auto& now = comparison.now().solvers;
  for (std::size_t i = 0; i < std::min(before.size(), now.size()); ++i) {
    print_solver(before[i], now[i]);
  }
  for (const auto& [name, entry] : comparison.now().process.entries()) {
    if (!entry.component) print_recorded("not replayed: '{}', {}\n", name, entry.why_not);
    if (entry.ends) {
      print_recorded("replayed up to its activation {}: '{}', {}\n", entry.activations, name,
                     *entry.ends);
    }
  }
}

Json json_of(const TopicDifferences& differences) {
  Json json{{"messages", differences.messages()},
            {"differing", differences.differing()},
            {"only_recorded", differences.only_before()},
            {"only_now", differences.only_now()},
            {"largest_joint_step", differences.joint_steps()},
            {"fields", Json::object()}};
  for (const auto& [name, field] : differences.fields()) {
    Json& told = json["fields"][name] = {{"messages", field.messages}, {"at_s", field.at_s}};
    if (field.is_number) {
      told["largest"] = field.largest;
    } else {
      told["recorded"] = field.before;
      told["now"] = field.now;
      told["element"] = field.element;
    }
  }
  return json;
}

Json json_of(const ComparedSide::Solver& solver) {
  Json json{{"component", solver.component},
            {"plugin", solver.plugin},
            {"calls", solver.calls.count},
            {"failed", solver.calls.failed},
            {"took_s", solver.calls.took_s}};
  if (solver.calls.first_failed) {
    json["first_failed"] = {{"answer", solver.calls.first_failed->answer},
                            {"line", line_for(*solver.calls.first_failed, solver)}};
  }
  if (solver.calls.slowest) {
    json["slowest"] = {{"took_s", solver.calls.slowest->took_s},
                       {"line", line_for(*solver.calls.slowest, solver)}};
  }
  return json;
}

Json json_of(const OtherFailure& failure) {
  return {{"at_s", failure.at_s}, {"recorded", failure.recorded}, {"now", failure.now}};
}

void add_repetition(const Repetition& repetition, Json& component) {
  if (repetition.unrecorded() > 0) component["not_recorded"] = repetition.unrecorded();
  if (const auto& otherwise = repetition.otherwise()) {
    component["not_repeated"] = {
        {"at_s", otherwise->at_s}, {"topic", otherwise->topic}, {"text", otherwise->text}};
  }
}

Json json_of(const Comparison& comparison) {
  Json json{{"process", comparison.process()}, {"complete", comparison.is_complete()},
            {"repeats", comparison.repeats()}, {"problems", comparison.problems()},
            {"components", Json::array()},     {"solvers", Json::array()}};
  for (const auto& [name, compared] : comparison.components()) {
    const TimingFigures before = times_of(comparison.before(), name);
    const TimingFigures now = times_of(comparison.now(), name);
    Json& told = json["components"].emplace_back();
    told = {{"component", name},
            {"activations", now.count},
            {"recorded_step_s", {{"p50", before.p50_s}, {"p99", before.p99_s}}},
            {"step_s", {{"p50", now.p50_s}, {"p99", now.p99_s}, {"max", now.max_s}}},
            {"slowest_at_s", *compared.slowest_at_s},
            {"topics", Json::object()}};
    for (const auto& [topic, differences] : compared.topics) {
      told["topics"][topic] = json_of(differences);
    }
    if (compared.failure) told["failure"] = json_of(*compared.failure);
    add_repetition(comparison.repetition(name), told);
    const auto& ends = comparison.now().process.entries().at(name).ends;
    if (ends) told["ends"] = *ends;
  }
  for (const auto& [name, entry] : comparison.now().process.entries()) {
    if (comparison.components().contains(name)) continue;
    Json& told = json["components"].emplace_back(Json{{"component", name}});
    if (!entry.component) told["not_replayed"] = entry.why_not;
    if (entry.ends) told["ends"] = *entry.ends;
  }
  const auto& before = comparison.before().solvers;
  const auto& now = comparison.now().solvers;
  for (std::size_t i = 0; i < std::min(before.size(), now.size()); ++i) {
    json["solvers"].push_back({{"recorded", json_of(before[i])}, {"now", json_of(now[i])}});
  }
  return json;
}

}  // namespace

int compare_with_recording(const ReplayOptions& options) {
  name_crashing_components();
  PluginRegistry plugins;
  Json json = Json::array();
  bool any = false, is_sound = true;
  std::set<std::string> told;  // of a file with several processes, once
  const auto tell = [&](const std::string& text) {
    if (told.insert(text).second) fmt::print(stderr, "armature: {}\n", terminal_text(text));
  };
  for (const std::filesystem::path& file : options.files) {
    for (const std::string& process : recorded_processes(file)) {
      Comparison comparison{file, process, options, plugins};
      any = any || !comparison.changed().empty();
      if (comparison.changed().empty()) continue;
      for (const std::string& note : comparison.notes()) tell(note);
      comparison.run();
      for (const std::string& problem : comparison.problems()) {
        tell(fmt::format("'{}': {}", file.string(), problem));
      }
      if (comparison.components().empty()) {
        tell(fmt::format("'{}': nothing of process '{}' was compared", file.string(), process));
      }
      is_sound = is_sound && comparison.is_complete() && comparison.repeats();
      if (options.json) {
        json.push_back(json_of(comparison));
      } else {
        print(comparison);
      }
    }
  }
  if (!any) throw InvalidChoice("the assignments change no component of the recording");
  if (options.json) print_out("{}\n", json_text(json));
  return is_sound ? kOk : kFailed;
}

}  // namespace armature
