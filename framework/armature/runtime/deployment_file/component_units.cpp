// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/deployment_file/component_units.hpp"

#include <algorithm>
#include <string>
#include <string_view>

namespace armature {
namespace {

bool belongs(const std::vector<std::string>& units, std::string_view unit) {
  return std::ranges::find(units, unit) != units.end();
}

void keep_of(std::string_view unit, ComponentConfig& component) {
  for (auto* ports : {&component.inputs, &component.outputs}) {
    std::erase_if(*ports, [&](const PortBinding& port) { return !belongs(port.spec.units, unit); });
  }
  std::erase_if(component.slots, [&](const SlotConfig& slot) {
    const auto spec = std::ranges::find(component.manifest->slots, slot.name, &SlotSpec::name);
    return spec != component.manifest->slots.end() && !belongs(spec->units, unit);
  });
}

}  // namespace

std::vector<ComponentConfig> units_of(const ComponentConfig& entry) {
  std::vector<ComponentConfig> units{entry};
  keep_of(kMainUnit, units.front());
  for (const UnitSpec& spec : entry.manifest->units) {
    ComponentConfig& unit = units.emplace_back(entry);
    unit.unit = spec.name;
    unit.name = entry.name + "." + spec.name;
    unit.executor = unit.name;
    unit.sim_latency = Duration{0};
    keep_of(spec.name, unit);
  }
  return units;
}

void add_unit_executors(DeploymentConfig& deployment) {
  for (const ComponentConfig& component : deployment.components) {
    const bool known = std::ranges::find(deployment.executors, component.executor,
                                         &ExecutorSpec::name) != deployment.executors.end();
    if (known || component.unit == kMainUnit) continue;
    deployment.executors.push_back({.name = component.executor, .period = {}, .priority = 0});
  }
}

}  // namespace armature
