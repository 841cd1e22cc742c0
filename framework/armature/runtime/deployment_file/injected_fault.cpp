// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/deployment_file/injected_fault.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <stdexcept>
#include <utility>

#include "armature/config/problems.hpp"

namespace armature {
namespace {

using Kind = InjectedFault::Kind;

std::atomic<bool> g_armed{false};

constexpr std::array kKinds{std::pair{"throw", Kind::throws}, std::pair{"hang", Kind::hangs},
                            std::pair{"crash", Kind::crashes}};

Kind read_kind(const std::string& word, const config::Origin& origin, config::Problems& problems) {
  for (const auto& [name, kind] : kKinds) {
    if (word == name) return kind;
  }
  const std::vector<std::string> known{"throw", "hang", "crash"};
  problems.add(origin,
               fmt::format("a component cannot '{}'{}", word, config::did_you_mean(word, known)));
  return Kind::throws;
}

void check_component(const std::string& name, const DeploymentConfig& deployment,
                     const config::Origin& origin, config::Problems& problems) {
  std::vector<std::string> known;
  for (const ComponentConfig& component : deployment.components) known.push_back(component.name);
  if (std::ranges::find(known, name) != known.end()) return;
  problems.add(origin, fmt::format("no component '{}'{}", name, config::did_you_mean(name, known)));
}

void check_drivers(const DeploymentConfig& deployment, const config::Origin& origin,
                   config::Problems& problems) {
  for (const ComponentConfig& component : deployment.components) {
    const auto& driver = component.manifest->driver;
    if (!driver || driver->simulated) continue;
    problems.add(origin, fmt::format("'{}' ({}) moves metal; faults are only put into a run whose "
                                     "drivers are all 'simulated: true'",
                                     component.name, component.manifest->id));
  }
}

}  // namespace

InjectedFault InjectedFault::read(std::string_view text, const DeploymentConfig& deployment) {
  const config::Origin origin{.file = fmt::format("--inject {}", text)};
  const std::size_t colon = std::min(text.find(':'), text.size());
  const std::string component{text.substr(0, colon)};
  config::Problems problems;
  const Kind kind =
      read_kind(std::string{text.substr(std::min(colon + 1, text.size()))}, origin, problems);
  check_component(component, deployment, origin, problems);
  check_drivers(deployment, origin, problems);
  problems.throw_if_any();
  return {component, kind};
}

void InjectedFault::listen() {
  g_armed = false;
  std::signal(SIGUSR1, [](int) { g_armed = true; });
}

void InjectedFault::strike_if_armed() const {
  if (!g_armed.load(std::memory_order_relaxed)) return;
  switch (kind_) {
    case Kind::throws: throw std::runtime_error{"a drill's fault"};
    case Kind::hangs:
      while (true) pause();
    case Kind::crashes: std::raise(SIGSEGV);
  }
}

}  // namespace armature
