// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/deployment_file/capabilities.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <optional>
#include <string_view>
#include <vector>

#include "armature/runtime/deployment_file/graph.hpp"

namespace armature {
namespace {

/// One of those that may help each other: the plugins in a component's slots, or the components of
/// a deployment.
struct Provider {
  std::string name;  // for messages: what the user calls it
  const PluginManifest* manifest;
  const Params* params;
  config::Origin origin;
};

bool holds(const Capability& capability, const Provider& provider) {
  if (capability.when.empty()) return true;
  switch (std::ranges::find(provider.manifest->params, capability.when, &ParamSpec::name)->type) {
    case ParamSpec::Type::flag: return provider.params->flag(capability.when);
    case ParamSpec::Type::integer: return provider.params->integer(capability.when) != 0;
    default: return provider.params->number(capability.when) != 0;
  }
}

const Capability* find_capability(const std::vector<Capability>& capabilities,
                                  std::string_view word) {
  const auto found = std::ranges::find(capabilities, word, &Capability::word);
  return found == capabilities.end() ? nullptr : &*found;
}

/// Who could provide `word`: one of the providers where it is switched off, else the plugins on
/// the search path that `fits` lets in; a word that nobody knows is a typo. nullopt when plugins
/// provide it that have no place here: who they work for may run in another process.
std::optional<std::string> hint(std::string_view word, const std::vector<Provider>& providers,
                                const PluginRegistry& plugins,
                                const std::function<bool(const PluginManifest&)>& fits) {
  for (const Provider& provider : providers) {
    if (const Capability* provided = find_capability(provider.manifest->provided, word)) {
      return fmt::format("'{}' does {}", provider.name,
                         unless_text(*provided, provider.manifest->params));
    }
  }
  std::vector<std::string> ids, words;
  bool elsewhere = false;
  for (const PluginManifest& plugin : plugins.plugins()) {
    for (const Capability& provided : plugin.provided) {
      words.push_back(provided.word);
      if (provided.word != word) continue;
      if (fits(plugin)) ids.push_back(plugin.id);
      elsewhere = true;
    }
  }
  if (!ids.empty()) return fmt::format("provided by {}", fmt::join(ids, ", "));
  if (elsewhere) return std::nullopt;
  return "no plugin on the search path does" + config::did_you_mean(word, words);
}

/// `needy` needs, and `others` may provide.
void check_required(const Provider& needy, const std::vector<Provider>& others,
                    std::string_view nobody, const PluginRegistry& plugins,
                    const std::function<bool(const PluginManifest&)>& fits,
                    config::Problems& problems) {
  for (const Capability& need : needy.manifest->required) {
    if (!holds(need, needy)) continue;
    const bool met = std::ranges::any_of(others, [&](const Provider& provider) {
      const Capability* provided = find_capability(provider.manifest->provided, need.word);
      return provided && holds(*provided, provider);
    });
    const auto who_could = hint(need.word, others, plugins, fits);
    if (met || !who_could) continue;
    const std::string unless = unless_text(need, needy.manifest->params);
    problems.add(needy.origin,
                 fmt::format("'{}' requires '{}'{}{}, and {} provides it; {}", needy.name,
                             need.word, unless.empty() ? "" : " ", unless, nobody, *who_could));
  }
}

Provider provider_of(const ComponentConfig& component) {
  return {component.name, component.manifest, &component.params, component.origin};
}

std::vector<Provider> slots_of(const ComponentConfig& component) {
  std::vector<Provider> providers;
  for (const SlotConfig& slot : component.slots) {
    providers.push_back({slot.plugin_id, slot.manifest, &slot.params, slot.origin});
  }
  return providers;
}

}  // namespace

void check_slot_needs(const ComponentConfig& component, const PluginRegistry& plugins,
                      config::Problems& problems) {
  // Alone on topics: who it works with does not stand in its entry.
  if (!component.manifest->hosts.empty()) return;
  // With a slot missing, what its plugin would provide is missing too, and that slot is a problem.
  const auto is_missing = [&](const SlotSpec& spec) {
    return !spec.optional && std::ranges::find(component.slots, spec.name, &SlotConfig::name) ==
                                 component.slots.end();
  };
  if (std::ranges::any_of(component.manifest->slots, is_missing)) return;
  const std::vector<Provider> providers = slots_of(component);
  const auto fits_a_slot = [&](const PluginManifest& plugin) {
    const auto& slots = component.manifest->slots;
    return std::ranges::find(slots, plugin.kind, &SlotSpec::kind) != slots.end();
  };
  std::vector<Provider> others = providers;
  others.push_back(provider_of(component));
  const std::string nobody = fmt::format("nothing in component '{}'", component.name);
  for (const Provider& needy : providers) {
    check_required(needy, others, nobody, plugins, fits_a_slot, problems);
  }
}

void check_component_needs(const DeploymentConfig& deployment, const PluginRegistry& plugins,
                           config::Problems& problems) {
  for (const ComponentConfig& needy : deployment.components) {
    if (needy.unit != kMainUnit) continue;  // what its component needs is asked once
    std::vector<Provider> others;
    std::vector<std::string_view> kinds{"component"};
    for (const ComponentConfig& component : deployment.components) {
      if (!exchange_topics(needy, component)) continue;
      others.push_back(provider_of(component));
      std::ranges::copy(slots_of(component), std::back_inserter(others));
      for (const SlotSpec& slot : component.manifest->slots) kinds.push_back(slot.kind);
    }
    const auto fits = [&](const PluginManifest& plugin) {
      return std::ranges::find(kinds, plugin.kind) != kinds.end();
    };
    check_required(provider_of(needy), others, "no component on its topics", plugins, fits,
                   problems);
  }
}

}  // namespace armature
