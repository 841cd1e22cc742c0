// SPDX-License-Identifier: Apache-2.0
#include "replay/replayed_process.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "armature/runtime/deployment/description.hpp"
#include "armature/runtime/deployment/tried_together.hpp"
#include "armature/runtime/execution/watchdog.hpp"
#include "armature/runtime/plugins/processor_level.hpp"
#include "armature/runtime/plugins/running_component.hpp"
#include "armature/runtime/recording/recorded_description.hpp"
#include "exit_code.hpp"
#include "replay/announced_volumes.hpp"

namespace armature {
namespace {

/// Why it cannot be repeated, or nothing. `lost`: of topics that announce volumes which are lost.
std::string why_not_replayed(const ComponentConfig& component,
                             const std::map<std::string, std::string>& lost) {
  const auto is_impure = [](const SlotConfig& slot) { return !slot.manifest->pure; };
  if (!component.manifest->pure) return component.plugin_id + " says pure: false";
  if (component.manifest->uses_files) {
    return component.plugin_id + " writes files, or reads those that messages name";
  }
  for (const PortBinding& input : component.inputs) {
    if (const auto why = lost.find(input.topic); why != lost.end()) return why->second;
  }
  const auto slot = std::ranges::find_if(component.slots, is_impure);
  return slot == component.slots.end() ? "" : slot->plugin_id + " says pure: false";
}

}  // namespace

ReplayedProcess::ReplayedProcess(RecordedRun& run, PluginRegistry& plugins,
                                 const std::vector<std::string>& assignments,
                                 const std::vector<std::string>& only)
    : run_{&run}, config_{run.read_config(plugins, assignments, notes_)} {
  note_other_libraries(run);
  for (const ComponentConfig& component : config_.components) {
    if (!config_.simulated) {  // whose time stands still in a call
      run.keep_for_call(declared_max_step(component, config_).value_or(Duration{0}));
    }
    run.keep_for_call(component.sim_latency);
    for (const PortBinding& input : component.inputs) {
      run.keep_at_least(input.topic, static_cast<std::size_t>(input.spec.queue.value_or(1)));
    }
  }
  try_together(config_, run.process());
  lost_volumes_ = lost_volumes(run.file());
  for (const auto& [name, ports] : run.components()) {
    const bool is_wanted = only.empty() || std::ranges::find(only, name) != only.end();
    if (is_wanted) construct(name, ports, plugins);
  }
}

void ReplayedProcess::note_other_libraries(const RecordedRun& run) {
  std::map<std::string, std::string> here;
  const msg::DeploymentDescription description = description_of(config_, run.process(), "");
  for (const auto& component : description.components_()) {
    for (const auto& plugin : component.plugins_()) here[plugin.plugin_()] = plugin.sha256_();
  }
  for (const auto& [plugin, sha256] : run.libraries()) {
    const auto found = here.find(plugin);
    if (found == here.end() || found->second == sha256) continue;
    notes_.push_back(fmt::format("{} is another build than the recorded one", plugin));
  }
}

void ReplayedProcess::construct(const std::string& name, const RecordedPorts& ports,
                                PluginRegistry& plugins) {
  Entry& entry = entries_[name];
  const auto config = std::ranges::find(config_.components, name, &ComponentConfig::name);
  entry.why_not = config == config_.components.end() ? "it is not in the file"
                                                     : why_not_replayed(*config, lost_volumes_);
  if (!entry.why_not.empty()) return;
  const RunningComponent running{name, "constructor"};
  entry.component = std::make_unique<ReplayedComponent>(*config, config_, plugins, ports);
  run_->keep_for_call(entry.component->runner().latency());
}

ReplayedProcess::Entry* ReplayedProcess::repeat(const msg::Activation& call, double at_s) {
  const auto found = entries_.find(call.component_());
  if (found == entries_.end() || !found->second.component || found->second.ends) return nullptr;
  Entry& entry = found->second;
  if (call.lost_before_() > 0) {
    entry.ends = fmt::format("{} of its activations were not recorded before {:.6f} s",
                             call.lost_before_(), at_s);
  } else if (const auto failure = entry.component->failure()) {
    entry.ends = "here " + *failure;
  } else if (const auto lacks = entry.component->repeat(call, *run_)) {
    entry.ends = *lacks;
  } else {
    ++entry.activations;
    return &entry;
  }
  return nullptr;
}

void check_processor(const RecordedRun& run) {
  if (run.processor() == processor_level()) return;
  throw InvalidChoice(fmt::format(
      "it was recorded on a processor of level {}, and this one is of level {}: solvers choose "
      "their instructions by it, and the last bits of numbers follow; --allow-ulp compares all "
      "the same",
      run.processor(), processor_level()));
}

}  // namespace armature
