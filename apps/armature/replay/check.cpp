// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "armature/config/problems.hpp"
#include "armature/recording/recorded_processes.hpp"
#include "armature/runtime/plugins/running_component.hpp"
#include "armature/values/json_text.hpp"
#include "armature/values/monotonic_now.hpp"
#include "exit_code.hpp"
#include "replay/exchanged_samples.hpp"
#include "replay/recorded_run.hpp"
#include "replay/recorded_text.hpp"
#include "replay/repetition.hpp"
#include "replay/replay.hpp"
#include "replay/replayed_process.hpp"
#include "standard_output.hpp"
#include "terminal_text.hpp"
#include "watch/outsider.hpp"

namespace armature {
namespace {

using Json = nlohmann::ordered_json;

/// All components of one process.
class Check {
 public:
  Check(const std::filesystem::path& file, const std::string& process, const ReplayOptions& options,
        PluginRegistry& plugins)
      : run_{file, process}, process_{run_, plugins, options.assignments} {
    if (!options.allow_ulp) check_processor(run_);
    run_.count_from_begin_of(options.files);
    for (const auto& [name, entry] : process_.entries()) compared_[name];
  }

  void run() {
    while (const auto call = run_.next()) {
      length_s_ = std::max(length_s_, run_.seconds_of(*call));
      repeat(*call, run_.seconds_of(*call));
    }
    for (const auto& [name, end] : run_.unrecorded_ends()) {
      const auto found = process_.entries().find(name);
      if (found != process_.entries().end() && !found->second.ends) found->second.ends = end;
    }
  }

  /// Whether all that can be repeated was repeated, and compared.
  bool is_complete() const {
    return problems().empty() && std::ranges::all_of(entries(), [&](const auto& entry) {
             return !entry.second.ends && of(entry.first).unrecorded() == 0;
           });
  }

  const std::map<std::string, ReplayedProcess::Entry>& entries() const {
    return process_.entries();
  }
  const Repetition& of(const std::string& component) const { return compared_.at(component); }
  const std::vector<std::string>& notes() const { return process_.notes(); }
  std::vector<std::string> problems() const { return run_.problems(); }
  const std::string& run_id() const { return run_.run(); }
  const std::filesystem::path& file() const { return run_.file(); }
  const std::string& process() const { return run_.process(); }
  double length_s() const { return length_s_; }
  const DeploymentConfig& config() const { return process_.config(); }

 private:
  void repeat(const msg::Activation& call, double at_s) {
    const ReplayedProcess::Entry* entry = process_.repeat(call, at_s);
    if (!entry) return;
    compared_[call.component_()].hold(call, at_s, entry->activations, *entry->component, run_);
  }

  RecordedRun run_;
  ReplayedProcess process_;
  std::map<std::string, Repetition> compared_;
  double length_s_ = 0;
};

struct Totals {
  bool is_complete = true;
  std::uint64_t components = 0, activations = 0, outputs = 0, differing = 0;
  double length_s = 0;
  ExchangedSamples exchanged;
  std::vector<std::string> missing;  // processes of the run whose recording was not given
};

std::vector<std::string> missing_of(const std::vector<std::unique_ptr<Check>>& checks) {
  std::vector<std::string> missing = checks.front()->config().processes();
  for (const auto& check : checks) std::erase(missing, check->process());
  return missing;
}

Totals totals_of(const std::vector<std::unique_ptr<Check>>& checks,
                 const ExchangedSamples& exchanged) {
  Totals totals{.exchanged = exchanged, .missing = missing_of(checks)};
  totals.is_complete = exchanged.unwritten == 0 && totals.missing.empty();
  for (const auto& check : checks) {
    totals.length_s = std::max(totals.length_s, check->length_s());
    totals.is_complete = totals.is_complete && check->is_complete();
    for (const auto& [name, entry] : check->entries()) {
      totals.components += entry.component ? 1 : 0;
      totals.activations += entry.activations;
      totals.outputs += check->of(name).outputs();
      totals.differing += check->of(name).otherwise() ? 1 : 0;
    }
  }
  totals.is_complete = totals.is_complete && totals.activations > 0;
  return totals;
}

std::string_view verdict_of(const Totals& totals) {
  if (totals.differing > 0) return "identical otherwise";
  return totals.is_complete ? "identical" : "incomplete, identical as far as it was compared";
}

std::string text_of(const std::string& component, const Repetition::Otherwise& difference) {
  return fmt::format("'{}' differs first at {:.6f} s, in its activation {} ({}){}{}: {}", component,
                     difference.at_s, with_commas(difference.activation), difference.call,
                     difference.topic.empty() ? "" : ", ", difference.topic, difference.text);
}

Json json_of(const Check& check, const std::string& name, const ReplayedProcess::Entry& entry) {
  Json json{{"component", name}, {"process", check.process()}};
  if (!entry.component) {
    json["not_replayed"] = entry.why_not;
    return json;
  }
  const Repetition& compared = check.of(name);
  json["activations"] = entry.activations;
  json["outputs"] = compared.outputs();
  if (compared.unrecorded() > 0) json["not_recorded"] = compared.unrecorded();
  if (entry.ends) json["ends"] = *entry.ends;
  if (!compared.otherwise()) return json;
  const Repetition::Otherwise& difference = *compared.otherwise();
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
  // A recording that was not all compared is not known to be identical: null, which is not true.
  const Json identical =
      totals.differing == 0 && !totals.is_complete ? Json{} : Json(totals.differing == 0);
  Json json{{"identical", identical},
            {"complete", totals.is_complete},
            {"problems", Json::array()},
            {"missing_processes", totals.missing},
            {"outputs", totals.outputs},
            {"activations", totals.activations},
            {"length_s", totals.length_s},
            {"took_s", took_s},
            {"exchanged",
             {{"compared", totals.exchanged.compared},
              {"numbered", totals.exchanged.numbered},
              {"unwritten", totals.exchanged.unwritten}}},
            {"components", Json::array()}};
  std::set<std::pair<std::filesystem::path, std::string>> told;
  for (const auto& check : checks) {
    for (const std::string& problem : check->problems()) {
      if (told.emplace(check->file(), problem).second) json["problems"].push_back(problem);
    }
    for (const auto& [name, entry] : check->entries()) {
      json["components"].push_back(json_of(*check, name, entry));
    }
  }
  print_out("{}\n", json_text(json));
}

void print(const ExchangedSamples& exchanged) {
  if (exchanged.compared > 0) {
    print_recorded(
        "{} samples that processes read of each other are as they were written, {} of them "
        "found by their writer's number\n",
        with_commas(exchanged.compared), with_commas(exchanged.numbered));
  }
  if (!exchanged.first) return;
  print_recorded(
      "{} are not: process '{}' read a sample of {} first at {:.6f} s that is not in the "
      "recording of its writer\n",
      with_commas(exchanged.unwritten), exchanged.first->reader, exchanged.first->topic,
      exchanged.first->at_s);
}

void print(const std::vector<std::unique_ptr<Check>>& checks, const Totals& totals, double took_s) {
  for (const auto& check : checks) {
    for (const auto& [name, entry] : check->entries()) {
      const auto& difference = check->of(name).otherwise();
      if (difference) print_recorded("{}\n", text_of(name, *difference));
    }
  }
  print_recorded(
      "{}: {} outputs of {} activations of {} components; {:.1f} s of the run in {:.1f} s\n",
      verdict_of(totals), with_commas(totals.outputs), with_commas(totals.activations),
      totals.components, totals.length_s, took_s);
  print(totals.exchanged);
  for (const auto& check : checks) {
    for (const auto& [name, entry] : check->entries()) {
      if (!entry.component) print_recorded("not replayed: '{}', {}\n", name, entry.why_not);
      if (entry.ends) {
        print_recorded("replayed up to its activation {}: '{}', {}\n",
                       with_commas(entry.activations), name, *entry.ends);
      }
      if (const auto unrecorded = check->of(name).unrecorded(); unrecorded > 0) {
        print_recorded("not compared: {} outputs of '{}', which are not in the recording\n",
                       with_commas(unrecorded), name);
      }
    }
  }
}

/// Of the file that came last and those before it.
void check_same_run(const std::vector<std::unique_ptr<Check>>& checks) {
  const Check& last = *checks.back();
  for (const auto& check : checks) {
    if (check == checks.back()) return;
    if (check->run_id() != last.run_id()) {
      throw InvalidChoice(fmt::format("'{}' and '{}' are of different runs", check->file().string(),
                                      last.file().string()));
    }
    if (check->process() == last.process()) {
      throw InvalidChoice(fmt::format("'{}' and '{}' are both of process '{}'",
                                      check->file().string(), last.file().string(),
                                      last.process()));
    }
  }
}

}  // namespace

int check_recording(const ReplayOptions& options) {
  name_crashing_components();
  PluginRegistry plugins;
  std::vector<std::unique_ptr<Check>> checks;
  const Time start = monotonic_now();
  std::set<std::string> told;  // of a file with several processes, once
  const auto tell = [&](const std::string& text) {
    if (told.insert(text).second) fmt::print(stderr, "armature: {}\n", terminal_text(text));
  };
  ExchangedSamples exchanged;  // of a file that was joined
  for (const std::filesystem::path& file : options.files) {
    exchanged += compare_exchanged(file);
    for (const std::string& process : recorded_processes(file)) {
      Check& check = *checks.emplace_back(std::make_unique<Check>(file, process, options, plugins));
      check_same_run(checks);
      for (const std::string& note : check.notes()) tell(note);
      check.run();
      for (const std::string& problem : check.problems()) {
        tell(fmt::format("'{}': {}", file.string(), problem));
      }
    }
  }
  const Totals totals = totals_of(checks, exchanged);
  for (const std::string& process : totals.missing) {
    tell(fmt::format("the recording of process '{}' of this run is missing", process));
  }
  const double took_s = to_seconds(monotonic_now() - start);
  if (options.json) {
    print_json(checks, totals, took_s);
  } else {
    print(checks, totals, took_s);
  }
  return totals.differing == 0 && totals.is_complete ? kOk : kFailed;
}

}  // namespace armature
