// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <iterator>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "armature/config/document.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/recording/recorded_processes.hpp"
#include "armature/runtime/plugins/running_component.hpp"
#include "armature/values/json_text.hpp"
#include "exit_code.hpp"
#include "replay/changed_components.hpp"
#include "replay/field_differences.hpp"
#include "replay/recorded_text.hpp"
#include "replay/repetition.hpp"
#include "replay/replay.hpp"
#include "replay/replayed_process.hpp"
#include "replay/watched_ik.hpp"
#include "shell_word.hpp"
#include "standard_output.hpp"
#include "terminal_text.hpp"

namespace armature {
namespace {

using Json = nlohmann::ordered_json;

/// A value of a parameter as one line of YAML.
std::string flow_text(const config::Node& value) {
  if (value.kind() != config::Node::Kind::sequence) {
    std::string text = config::to_yaml(value, false);
    text.pop_back();
    return text;
  }
  std::string list;
  for (const config::Node& item : value.items()) {
    list += (list.empty() ? "" : ", ") + flow_text(item);
  }
  return '[' + list + ']';
}

/// The components of `run` that are other ones with the assignments.
std::vector<std::string> changed_of(const RecordedRun& run, PluginRegistry& plugins,
                                    const std::vector<std::string>& assignments) {
  std::vector<std::string> notes;  // are told by the sides
  std::vector<std::string> changed = changed_components(
      run.read_config(plugins, {}, notes), run.read_config(plugins, assignments, notes));
  std::erase_if(changed, [&](const std::string& name) { return !run.components().contains(name); });
  return changed;
}

/// One of the two that are compared, with its solvers of inverse kinematics watched.
struct Side {
  struct Solver {
    std::string component, plugin, robot, params;
    IkCalls calls;
  };

  Side(RecordedRun& run, PluginRegistry& plugins, const std::vector<std::string>& assignments,
       const std::vector<std::string>& changed)
      : process{run, plugins, assignments, changed} {
    for (auto& [name, entry] : process.entries()) {
      if (entry.component) watch(name, *entry.component, plugins);
    }
  }

  void watch(const std::string& name, ReplayedComponent& component, PluginRegistry& plugins) {
    const DeploymentConfig& deployment = process.config();
    const auto config = std::ranges::find(deployment.components, name, &ComponentConfig::name);
    for (const SlotConfig& slot : config->slots) {
      if (slot.manifest->kind != IkSolver::kKind) continue;
      const auto place = std::ranges::find(component.runner().slots(), slot.name,
                                           [](const auto& known) { return known->name(); });
      if (place == component.runner().slots().end()) continue;
      Solver& solver = solvers.emplace_back();
      solver = {.component = name,
                .plugin = slot.plugin_id,
                .robot = robot_of(*config),
                .params = given_params(*config, slot.name)};
      const auto watching = watch_ik(
          **place, {plugins.load(*slot.manifest, slot.manifest->kind), *slot.manifest, slot.params},
          solver.calls);
      if (!watching) throw std::runtime_error(watching.error().text);
    }
  }

  /// The parameters of a slot that are not its plugin's own defaults, "{max_steps: 20}", or
  /// nothing.
  std::string given_params(const ComponentConfig& component, const std::string& slot) const {
    const config::Node* entry = process.config().file.find("components");
    for (const std::string& key :
         {std::string{component.component()}, slot, std::string{"params"}}) {
      entry = entry ? entry->find(key) : nullptr;
    }
    std::string text;
    if (!entry) return text;
    for (const auto& [key, origin, value] : entry->entries()) {
      if (value.origin().file.starts_with("default of ")) continue;
      text += fmt::format("{}{}: {}", text.empty() ? "{" : ", ", key, flow_text(value));
    }
    return text.empty() ? text : text + "}";
  }

  std::string robot_of(const ComponentConfig& component) const {
    const auto bound = component.documents.find("robots");
    if (bound == component.documents.end()) return "ROBOT";
    return process.config().documents.at("robots").at(bound->second).origin().file;
  }

  ReplayedProcess process;
  std::deque<Solver> solvers;  // stay where they are
};

/// The first call that failed with another text than in the recording, or on one side only.
struct OtherFailure {
  double at_s = 0;
  std::string recorded, now;  // empty: it did not fail
};

/// What is compared of one component.
struct ComparedComponent {
  std::map<std::string, TopicDifferences> topics;
  std::optional<OtherFailure> failure;
  std::optional<double> slowest_at_s;
  Duration slowest{0};
};

class Comparison {
 public:
  Comparison(const std::filesystem::path& file, const std::string& process,
             const ReplayOptions& options, PluginRegistry& plugins)
      : run_{file, process},
        changed_{changed_of(run_, plugins, options.assignments)},
        before_{run_, plugins, {}, or_none(changed_)},
        now_{run_, plugins, options.assignments, or_none(changed_)} {
    if (!options.allow_ulp && !changed_.empty()) check_processor(run_);
  }

  void run() {
    std::optional<Time> start;
    while (const auto call = run_.next()) {
      const Time now = stamp_of(call->now_());
      if (!start) start = now;
      repeat(*call, to_seconds(now - *start));
    }
    for (const auto& [name, end] : run_.unrecorded_ends()) {
      const auto found = now_.process.entries().find(name);
      if (found != now_.process.entries().end() && !found->second.ends) found->second.ends = end;
    }
  }

  const std::string& process() const { return run_.process(); }
  /// Damage and gaps of the recording, one line each.
  std::vector<std::string> problems() const { return run_.problems(); }
  /// Notes on both runs, the recorded one and the one with other settings, each once.
  std::set<std::string> notes() const {
    std::set<std::string> notes{before_.process.notes().begin(), before_.process.notes().end()};
    notes.insert(now_.process.notes().begin(), now_.process.notes().end());
    return notes;
  }
  /// Whether all that can be repeated was repeated, and held to the recording, and something was.
  bool is_complete() const {
    const auto ends = [](const auto& entry) { return entry.second.ends.has_value(); };
    const auto is_unrecorded = [](const auto& held) { return held.second.unrecorded() > 0; };
    return problems().empty() && !components_.empty() &&
           std::ranges::none_of(repetitions_, is_unrecorded) &&
           std::ranges::none_of(before_.process.entries(), ends) &&
           std::ranges::none_of(now_.process.entries(), ends);
  }

  /// Whether all that is called recorded is what was recorded.
  bool repeats() const {
    return std::ranges::none_of(
        repetitions_, [](const auto& held) { return held.second.otherwise().has_value(); });
  }
  /// Of one of components().
  const Repetition& repetition(const std::string& component) const {
    return repetitions_.at(component);
  }

  const std::vector<std::string>& changed() const { return changed_; }
  const std::map<std::string, ComparedComponent>& components() const { return components_; }
  const Side& before() const { return before_; }
  const Side& now() const { return now_; }

 private:
  /// No component has this name: none is constructed, instead of all.
  static std::vector<std::string> or_none(const std::vector<std::string>& names) {
    return names.empty() ? std::vector<std::string>{""} : names;
  }

  void repeat(const msg::Activation& call, double at_s) {
    // In turn, so that neither always finds the caches warm.
    now_first_ = !now_first_;
    ReplayedProcess::Entry* first = (now_first_ ? now_ : before_).process.repeat(call, at_s);
    ReplayedProcess::Entry* second = (now_first_ ? before_ : now_).process.repeat(call, at_s);
    const ReplayedProcess::Entry* before = now_first_ ? second : first;
    const ReplayedProcess::Entry* now = now_first_ ? first : second;
    if (before) repetitions_[call.component_()].hold(call, at_s, *before->component, run_);
    if (!before || !now) return;
    ComparedComponent& compared = components_[call.component_()];
    compare(before->component->published(), now->component->published(), at_s, compared);
    compare_failure(call.failure_(), now->component->failure().value_or(""), at_s, compared);
    const Duration took{now->component->runner().times().duration.counts().last_ns};
    if (compared.slowest_at_s && took <= compared.slowest) return;
    compared.slowest_at_s = at_s;
    compared.slowest = took;
  }

  static void compare(const std::vector<ReplayedMessage>& before,
                      const std::vector<ReplayedMessage>& now, double at_s,
                      ComparedComponent& compared) {
    std::set<std::string> topics;
    for (const ReplayedMessage& message : before) topics.insert(message.topic);
    for (const ReplayedMessage& message : now) topics.insert(message.topic);
    for (const std::string& topic : topics) {
      const auto first = messages_of(before, topic), second = messages_of(now, topic);
      const std::size_t common = std::min(first.size(), second.size());
      TopicDifferences& differences = compared.topics[topic];
      for (std::size_t i = 0; i < common; ++i) {
        differences.compare(*first[i]->type, first[i]->cdr, second[i]->cdr, at_s);
      }
      for (std::size_t i = common; i < first.size(); ++i) {
        differences.add_only_before(*first[i]->type, first[i]->cdr);
      }
      for (std::size_t i = common; i < second.size(); ++i) {
        differences.add_only_now(*second[i]->type, second[i]->cdr);
      }
    }
  }

  static void compare_failure(const std::string& recorded, const std::string& now, double at_s,
                              ComparedComponent& compared) {
    if (recorded == now || compared.failure) return;
    compared.failure = {.at_s = at_s, .recorded = recorded, .now = now};
  }

  static std::vector<const ReplayedMessage*> messages_of(const std::vector<ReplayedMessage>& all,
                                                         const std::string& topic) {
    std::vector<const ReplayedMessage*> messages;
    for (const ReplayedMessage& message : all) {
      if (message.topic == topic) messages.push_back(&message);
    }
    return messages;
  }

  RecordedRun run_;
  std::vector<std::string> changed_;
  Side before_, now_;
  std::map<std::string, ComparedComponent> components_;
  std::map<std::string, Repetition> repetitions_;  // of those of the recorded side
  bool now_first_ = false;
};

std::string line_for(const IkCalls::Call& call, const Side::Solver& solver) {
  return fmt::format("echo {} | armature ik --robot {} --plugin {}{}", shell_word(call.question),
                     shell_word(solver.robot), solver.plugin,
                     solver.params.empty() ? "" : " --params " + shell_word(solver.params));
}

TimingFigures times_of(const Side& side, const std::string& component) {
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

void print_solver(const Side::Solver& before, const Side::Solver& now) {
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

Json json_of(const Side::Solver& solver) {
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
