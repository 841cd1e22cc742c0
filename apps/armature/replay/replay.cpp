// SPDX-License-Identifier: Apache-2.0
#include "replay/replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "armature/messages/known_types.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/runtime/deployment/description.hpp"
#include "armature/runtime/plugins/running_component.hpp"
#include "armature/runtime/recording/recorded_description.hpp"
#include "exit_code.hpp"
#include "replay/message_difference.hpp"
#include "replay/recorded_run.hpp"
#include "replay/replayed_component.hpp"
#include "watch/outsider.hpp"

namespace armature {
namespace {

using Json = nlohmann::ordered_json;

/// Where a component did something else than in the recording.
struct Difference {
  std::uint64_t activation = 0;  // counts from 1
  std::string call;
  double at_s = 0;  // since the recording began
  std::string topic;
  std::string text;  // "position[2]: recorded 1, replayed 2, 4503599627370496 ULP apart"
  std::optional<MessageDifference> field;
};

/// A component of the recording, and what came of its calls.
struct Checked {
  std::unique_ptr<ReplayedComponent> component;  // null: not replayed
  std::string why_not;
  std::uint64_t activations = 0, outputs = 0, unrecorded = 0;
  std::optional<Difference> difference;
  std::optional<std::string> ends;  // why it was not replayed to the end
};

std::string_view call_name(std::uint8_t call) {
  constexpr std::array<std::string_view, 3> kNames{"step", "begin_stop", "stop"};
  return call < kNames.size() ? kNames[call] : "?";
}

std::string with_commas(std::uint64_t number) {
  std::string text = std::to_string(number);
  for (std::size_t i = text.size(); i > 3; i -= 3) text.insert(i - 3, ",");
  return text;
}

/// All components of one process.
class Check {
 public:
  Check(const std::filesystem::path& file, const ReplayOptions& options, PluginRegistry& plugins)
      : options_{options}, run_{file} {
    check_processor();
    config_ = run_.read_config(plugins, options.assignments, notes_);
    note_other_libraries();
    std::size_t deepest = 0;
    for (const auto& [name, ports] : run_.components()) add(name, ports, plugins, deepest);
    run_.keep_at_least(deepest + 64);
  }

  void run() {
    std::optional<Time> start;
    while (const auto call = run_.next()) {
      const Time now = stamp_of(call->now_());
      if (!start) start = now;
      length_ = std::max(length_, now - *start);
      const auto found = components_.find(call->component_());
      if (found != components_.end()) repeat(*call, to_seconds(now - *start), found->second);
    }
  }

  const std::map<std::string, Checked>& components() const { return components_; }
  const std::vector<std::string>& notes() const { return notes_; }
  const std::vector<std::string>& problems() const { return run_.problems(); }
  const std::string& process() const { return run_.process(); }
  double length_s() const { return to_seconds(length_); }

 private:
  void check_processor() const {
    if (run_.processor() == processor_level() || options_.allow_ulp) return;
    throw InvalidChoice(fmt::format(
        "it was recorded on a processor of level {}, and this one is of level {}: solvers choose "
        "their instructions by it, and the last bits of numbers follow; --allow-ulp compares all "
        "the same",
        run_.processor(), processor_level()));
  }

  void note_other_libraries() {
    const msg::DeploymentDescription here = description_of(config_, run_.process(), "");
    std::map<std::string, std::string> now;
    for (const auto& component : here.components_()) {
      for (const auto& plugin : component.plugins_()) now[plugin.plugin_()] = plugin.sha256_();
    }
    for (const auto& [plugin, sha256] : run_.libraries()) {
      const auto found = now.find(plugin);
      if (found == now.end() || found->second == sha256) continue;
      notes_.push_back(fmt::format("{} is another build than the recorded one", plugin));
    }
  }

  void add(const std::string& name, const RecordedPorts& ports, PluginRegistry& plugins,
           std::size_t& deepest) {
    Checked& checked = components_[name];
    const auto config = std::ranges::find(config_.components, name, &ComponentConfig::name);
    if (config == config_.components.end()) {
      checked.why_not = "it is not in the file";
      return;
    }
    const auto is_impure = [](const SlotConfig& slot) { return !slot.manifest->pure; };
    if (!config->manifest->pure || std::ranges::any_of(config->slots, is_impure)) {
      checked.why_not = "pure: false";
      return;
    }
    for (const PortBinding& input : config->inputs) {
      deepest = std::max(deepest, static_cast<std::size_t>(input.spec.queue.value_or(1)));
    }
    const RunningComponent running{name, "constructor"};
    checked.component = std::make_unique<ReplayedComponent>(*config, config_, plugins, ports);
  }

  void repeat(const msg::Activation& call, double at_s, Checked& checked) {
    if (!checked.component || checked.ends) return;
    if (call.lost_before_() > 0) {
      checked.ends = fmt::format("{} of its activations were not recorded before {:.6f} s",
                                 call.lost_before_(), at_s);
      return;
    }
    if (const auto failure = checked.component->failure()) {
      if (!checked.difference) {
        checked.difference = difference(call, at_s, checked.activations, "", *failure);
      }
      checked.ends = "it has failed";
      return;
    }
    ++checked.activations;
    if (const auto lacks = checked.component->repeat(call, run_)) {
      checked.ends = *lacks;
      return;
    }
    compare(call, at_s, checked);
  }

  void compare(const msg::Activation& call, double at_s, Checked& checked) {
    const auto& published = checked.component->published();
    const std::size_t common = std::min(published.size(), call.written_().size());
    for (std::size_t i = 0; i < common; ++i) {
      const msg::SampleWritten& written = call.written_()[i];
      const auto recorded = run_.sample(written.writer_(), written.sequence_());
      if (published[i].writer != written.writer_()) {
        return note(call, at_s, checked, published[i].topic, "published where it had not");
      }
      if (!recorded) {
        ++checked.unrecorded;
      } else if (std::ranges::equal(*recorded, published[i].cdr)) {
        ++checked.outputs;
      } else {
        return note(call, at_s, checked, published[i], *recorded);
      }
    }
    if (published.size() == call.written_().size()) return;
    const std::string topic = published.size() > common ? published[common].topic : "";
    note(
        call, at_s, checked, topic,
        fmt::format("recorded {} messages, replayed {}", call.written_().size(), published.size()));
  }

  static Difference difference(const msg::Activation& call, double at_s, std::uint64_t activation,
                               const std::string& topic, std::string text) {
    return {.activation = activation,
            .call = std::string{call_name(call.call_())},
            .at_s = at_s,
            .topic = topic,
            .text = std::move(text),
            .field = {}};
  }

  static void note(const msg::Activation& call, double at_s, Checked& checked,
                   const std::string& topic, const std::string& text) {
    if (checked.difference) return;
    checked.difference = difference(call, at_s, checked.activations, topic, text);
  }

  static void note(const msg::Activation& call, double at_s, Checked& checked,
                   const ReplayedMessage& message, std::span<const std::byte> recorded) {
    if (checked.difference) return;
    const TypeDescription* type = describe_type(message.type->dds_name);
    auto field = type ? first_difference(*type, recorded, message.cdr) : std::nullopt;
    std::string text = "other bytes of equal values";
    if (field) {
      text = fmt::format("{}: recorded {}, replayed {}", field->field, field->recorded,
                         field->replayed);
      if (field->ulps) text += fmt::format(", {} ULP apart", with_commas(*field->ulps));
    }
    checked.difference =
        difference(call, at_s, checked.activations, message.topic, std::move(text));
    checked.difference->field = std::move(field);
  }

  const ReplayOptions& options_;
  RecordedRun run_;
  DeploymentConfig config_;
  std::vector<std::string> notes_;
  std::map<std::string, Checked> components_;
  Duration length_{0};
};

struct Totals {
  std::uint64_t components = 0, activations = 0, outputs = 0, differing = 0;
  double length_s = 0;
};

Totals totals_of(const std::vector<std::unique_ptr<Check>>& checks) {
  Totals totals;
  for (const auto& check : checks) {
    totals.length_s = std::max(totals.length_s, check->length_s());
    for (const auto& [name, checked] : check->components()) {
      totals.components += checked.component ? 1 : 0;
      totals.activations += checked.activations;
      totals.outputs += checked.outputs;
      totals.differing += checked.difference ? 1 : 0;
    }
  }
  return totals;
}

std::string text_of(const std::string& component, const Difference& difference) {
  return fmt::format("'{}' differs first at {:.6f} s, in its activation {} ({}){}{}: {}", component,
                     difference.at_s, with_commas(difference.activation), difference.call,
                     difference.topic.empty() ? "" : ", ", difference.topic, difference.text);
}

Json json_of(const std::string& process, const std::string& name, const Checked& checked) {
  Json json{{"component", name}, {"process", process}};
  if (!checked.component) {
    json["not_replayed"] = checked.why_not;
    return json;
  }
  json["activations"] = checked.activations;
  json["outputs"] = checked.outputs;
  if (checked.ends) json["ends"] = *checked.ends;
  if (!checked.difference) return json;
  const Difference& difference = *checked.difference;
  json["difference"] = {{"activation", difference.activation},
                        {"call", difference.call},
                        {"at_s", difference.at_s},
                        {"topic", difference.topic},
                        {"text", difference.text}};
  if (!difference.field) return json;
  json["difference"]["field"] = difference.field->field;
  json["difference"]["recorded"] = difference.field->recorded;
  json["difference"]["replayed"] = difference.field->replayed;
  if (difference.field->ulps) json["difference"]["ulps"] = *difference.field->ulps;
  return json;
}

void print_json(const std::vector<std::unique_ptr<Check>>& checks, const Totals& totals,
                double took_s) {
  Json json{{"identical", totals.differing == 0},
            {"outputs", totals.outputs},
            {"activations", totals.activations},
            {"length_s", totals.length_s},
            {"took_s", took_s},
            {"components", Json::array()}};
  for (const auto& check : checks) {
    for (const auto& [name, checked] : check->components()) {
      json["components"].push_back(json_of(check->process(), name, checked));
    }
  }
  fmt::print("{}\n", json.dump());
}

void print(const std::vector<std::unique_ptr<Check>>& checks, const Totals& totals, double took_s) {
  for (const auto& check : checks) {
    for (const auto& [name, checked] : check->components()) {
      if (checked.difference) fmt::print("{}\n", text_of(name, *checked.difference));
    }
  }
  fmt::print("{}: {} outputs of {} activations of {} components; {:.1f} s of the run in {:.1f} s\n",
             totals.differing == 0 ? "identical" : "identical otherwise",
             with_commas(totals.outputs), with_commas(totals.activations), totals.components,
             totals.length_s, took_s);
  for (const auto& check : checks) {
    for (const auto& [name, checked] : check->components()) {
      if (!checked.component) fmt::print("not replayed: '{}', {}\n", name, checked.why_not);
      if (checked.ends) {
        fmt::print("replayed up to its activation {}: '{}', {}\n", with_commas(checked.activations),
                   name, *checked.ends);
      }
      if (checked.unrecorded > 0) {
        fmt::print("not compared: {} outputs of '{}', which are not in the recording\n",
                   with_commas(checked.unrecorded), name);
      }
    }
  }
}

}  // namespace

int replay_recording(const ReplayOptions& options) {
  name_crashing_components();
  PluginRegistry plugins;
  std::vector<std::unique_ptr<Check>> checks;
  const Time start = monotonic_now();
  bool is_whole = true;
  for (const std::filesystem::path& file : options.files) {
    checks.push_back(std::make_unique<Check>(file, options, plugins));
    for (const std::string& note : checks.back()->notes()) {
      fmt::print(stderr, "armature: {}\n", note);
    }
    checks.back()->run();
    for (const std::string& problem : checks.back()->problems()) {
      is_whole = false;
      fmt::print(stderr, "armature: '{}': {}\n", file.string(), problem);
    }
  }
  const Totals totals = totals_of(checks);
  const double took_s = to_seconds(monotonic_now() - start);
  if (options.json) {
    print_json(checks, totals, took_s);
  } else {
    print(checks, totals, took_s);
  }
  return totals.differing == 0 && is_whole ? kOk : kFailed;
}

}  // namespace armature
