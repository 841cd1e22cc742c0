// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/ik/verify/plugin_subject.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "armature/config/problems.hpp"
#include "armature/laws/leak_check.hpp"
#include "armature/values/sanitizer.hpp"

namespace armature {
namespace {

constexpr std::string_view kAllBranches = "all_branches", kAnySeed = "any_seed",
                           kAnySeedAtEdges = "any_seed_at_edges";

/// True when the plugin provides `word` with these parameters.
bool provides(const PluginManifest& plugin, std::string_view word, const Params& params) {
  const auto promise = std::ranges::find(plugin.provided, word, &Capability::word);
  if (promise == plugin.provided.end()) return false;
  if (promise->when.empty()) return true;
  const auto param = std::ranges::find(plugin.params, promise->when, &ParamSpec::name);
  if (param == plugin.params.end()) return false;
  switch (param->type) {
    case ParamSpec::Type::flag: return params.flag(promise->when);
    case ParamSpec::Type::integer: return params.integer(promise->when) != 0;
    default: return params.number(promise->when) != 0;
  }
}

}  // namespace

Expected<IkSubject> plugin_subject(PluginRegistry& plugins, const PluginManifest& plugin,
                                   std::shared_ptr<const RobotModel> model, const Params& params) {
  auto made = plugins.make<IkSolver>(plugin.id, *model, params);
  if (!made) return tl::unexpected{made.error()};
  auto held = std::make_shared<PluginPtr<IkSolver>>(std::move(*made));
  IkSubject subject;
  subject.model = std::move(model);
  subject.solver = std::shared_ptr<const IkSolver>{held, &**held};
  subject.closed_form = provides(plugin, kAllBranches, params);
  subject.any_seed = subject.closed_form || provides(plugin, kAnySeed, params);
  subject.any_seed_at_edges = subject.closed_form || provides(plugin, kAnySeedAtEdges, params);
  subject.allocates = plugin.allocates;
  return subject;
}

std::string wrong_promises(const PluginManifest& plugin) {
  const std::array known{std::string{kAllBranches}, std::string{kAnySeed},
                         std::string{kAnySeedAtEdges}};
  for (const Capability& promise : plugin.provided) {
    if (std::ranges::find(known, promise.word) != known.end()) continue;
    return fmt::format("its plugin.yaml provides '{}', which is no promise of the kind ik{}",
                       promise.word, config::did_you_mean(promise.word, known));
  }
  return "";
}

LawReport check_loading(const std::vector<std::filesystem::path>& search_path,
                        std::string_view plugin_id, const RobotModel& model, const Params& params,
                        int cycles) {
  constexpr double kBudget_s = 60;
  PluginRegistry plugins{search_path};
  const PluginManifest* plugin = plugins.find(plugin_id);
  LawReport report;
  if (!plugin) {
    report.skipped = plugins.unknown_text(plugin_id);
    return report;
  }
  IkGoal goal;
  const JointVector seed = resting_position(model);
  goal.pose.position = {0.1, 0.2, 0.3};
  if (!model.pointing_axis()) goal.pose.orientation = Eigen::Quaterniond::Identity();
  const LeakCheck leaks = check_for_leaks(plugin->file, cycles, kBudget_s, [&] {
    const auto solver = plugins.make<IkSolver>(plugin_id, model, params);
    if (!solver) return;
    IkBranches found;
    IkState state;
    (*solver)->solve(goal, seed, found, state);
    ++report.questions;
  });
  report.note = fmt::format("{} times{}{}", leaks.cycles,
                            leaks.cycles < cycles ? ", as often as 60 s allow" : "",
                            kSanitized ? ", memory is not counted under a sanitizer" : "");
  if (const std::string fault = leaks.fault(); !fault.empty()) {
    report.failed = 1;
    report.violations.push_back({fault, ""});
  }
  return report;
}

}  // namespace armature
