// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/processes/arm_ownership.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "armature/runtime/processes/running_processes.hpp"

namespace armature {
namespace {

/// The parameter that names the driver's device, as text; empty: it names none.
std::string device_of(const ComponentConfig& component) {
  using Type = ParamSpec::Type;
  const std::string& name = component.manifest->driver->device;
  if (name.empty()) return {};
  const auto spec = std::ranges::find(component.manifest->params, name, &ParamSpec::name);
  switch (spec->type) {
    case Type::text:
    case Type::choice: return component.params.text(name);
    case Type::file: return component.params.file(name);
    case Type::integer: return std::to_string(component.params.integer(name));
    default: return fmt::format("{}", component.params.number(name));
  }
}

/// The same for every name of a device: udev gives it several.
std::string real_name(const std::string& device) {
  std::error_code none;
  const auto real = std::filesystem::canonical(device, none);
  return none ? device : real.string();
}

struct Arm {
  std::string lock;  // its name
  std::string text;  // "the arm at '/dev/ttyUSB0'"
  std::string process, host = {};
};

std::vector<Arm> arms_of_metal(const DeploymentConfig& deployment) {
  std::vector<Arm> arms;
  for (const ComponentConfig& component : deployment.components) {
    const auto& driver = component.manifest->driver;
    if (!driver || driver->simulated) continue;
    const std::string device = device_of(component);
    const std::string& id = component.manifest->id;
    arms.push_back(
        device.empty()
            ? Arm{"plugin " + id, fmt::format("the arm of '{}'", id), {}}
            : Arm{"device " + real_name(device), fmt::format("the arm at '{}'", device), {}});
    arms.back().process = component.process;
    arms.back().host = component.host;
  }
  return arms;
}

/// A second one would be taken for the first: its samples carry the deployment's fingerprint.
InstanceLock own_process(const DeploymentConfig& deployment, const std::string& process,
                         int domain) {
  const bool is_main = process == kMainProcess;
  auto taken = InstanceLock::take(lock_of_process(deployment.name, domain, process));
  if (taken) return std::move(*taken);
  throw std::runtime_error{
      fmt::format("{}deployment '{}' already runs as {} on domain {}; stop it, or use another "
                  "domain with --domain",
                  is_main ? "" : fmt::format("process '{}' of ", process), deployment.name,
                  taken.error().text, domain)};
}

}  // namespace

std::vector<InstanceLock> own_arms(const DeploymentConfig& deployment, const std::string& process,
                                   int domain) {
  const bool is_main = process == kMainProcess;
  std::vector<InstanceLock> locks;
  locks.push_back(own_process(deployment, process, domain));
  std::set<std::pair<std::string, std::string>> known;  // by host: each has devices of its own
  for (const Arm& arm : arms_of_metal(deployment)) {
    if (!known.emplace(arm.host, arm.lock).second) {
      throw std::runtime_error{
          fmt::format("two components drive {}; give each a device of its own", arm.text)};
    }
    const auto refuse_if = [&](const auto& result) {
      if (result) return;
      throw std::runtime_error{
          fmt::format("{} is driven by {} already; stop it first", arm.text, result.error().text)};
    };
    if (arm.process == process) {
      auto taken = InstanceLock::take(arm.lock);
      refuse_if(taken);
      locks.push_back(std::move(*taken));
    } else if (is_main && arm.host == kMainHost) {
      refuse_if(InstanceLock::check(arm.lock));
    }
  }
  return locks;
}

}  // namespace armature
