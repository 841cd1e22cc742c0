// SPDX-License-Identifier: Apache-2.0
#include "watch/seen_deployments.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

#include "armature/messages/stamp.hpp"

namespace armature {
namespace {

constexpr std::string_view kDescription = "/description", kStates = "/component_states";

/// "dental_lamp" of "rt/dental_lamp/component_state"; empty: the topic is another one.
std::string deployment_of(const ObservedTopic& topic, std::string_view suffix,
                          const MessageType& type) {
  constexpr std::string_view kRoot = "rt/";
  const bool is_it = topic.name.starts_with(kRoot) && topic.name.ends_with(suffix) &&
                     topic.types.size() == 1 && topic.types.front() == type.dds_name;
  return is_it ? topic.name.substr(kRoot.size(), topic.name.size() - kRoot.size() - suffix.size())
               : "";
}

double per(double amount, Duration time) {
  return time > Duration{0} ? amount / to_seconds(time) : 0;
}

}  // namespace

std::vector<std::string> SeenDeployment::missing() const {
  std::vector<std::string> missing;
  if (processes.empty()) return missing;
  std::ranges::copy_if(processes.begin()->second.processes_(), std::back_inserter(missing),
                       [&](const std::string& process) { return !processes.contains(process); });
  return missing;
}

SeenComponent seen_after(const std::optional<SeenComponent>& before, SeenComponent now) {
  // Whoever counts less than before has been started again.
  if (!before || now.state.activations_() < before->state.activations_()) return now;
  const auto activations =
      static_cast<double>(now.state.activations_() - before->state.activations_());
  now.rate_hz = per(activations, now.stamp - before->stamp);
  now.processor = per(activations * now.state.processor_().mean_(), now.told - before->told);
  return now;
}

SeenDeployments::SeenDeployments(const WatchOptions& options, std::string name)
    : name_{std::move(name)}, outsider_{options} {}

void SeenDeployments::look() {
  std::set<std::string> there;
  for (const ObservedTopic& topic : outsider_.dds().topics()) {
    if (topic.writers == 0) continue;
    const std::string described =
        deployment_of(topic, kDescription, message_type<msg::DeploymentDescription>());
    const std::string told = deployment_of(topic, kStates, message_type<msg::ComponentStates>());
    const std::string& deployment = described.empty() ? told : described;
    if (deployment.empty() || (!name_.empty() && deployment != name_)) continue;
    there.insert(deployment);
    if (watched_.contains(topic.name)) continue;
    const auto watching =
        outsider_.dds().watch(topic.name, Duration{0}, [=, this](const ObservedSample& sample) {
          if (!described.empty()) {
            if (auto description = decoded<msg::DeploymentDescription>(sample)) add(*description);
          } else if (const auto states = decoded<msg::ComponentStates>(sample)) {
            add(deployment, *states, sample.source);
          }
        });
    if (watching) watched_.insert(topic.name);
  }
  const std::scoped_lock lock{mutex_};
  std::erase_if(seen_, [&](const auto& entry) { return !there.contains(entry.first); });
}

std::map<std::string, SeenDeployment> SeenDeployments::all() const {
  const std::scoped_lock lock{mutex_};
  return seen_;
}

void SeenDeployments::add(const msg::DeploymentDescription& description) {
  const std::scoped_lock lock{mutex_};
  SeenDeployment& deployment = seen_[description.deployment_()];
  const bool another_run = !deployment.processes.empty() &&
                           deployment.processes.begin()->second.run_() != description.run_();
  if (another_run) deployment = {};
  deployment.processes[description.process_()] = description;
}

void SeenDeployments::add(const std::string& deployment, const msg::ComponentStates& states,
                          Time told) {
  const std::scoped_lock lock{mutex_};
  auto& components = seen_[deployment].components;
  const Time stamp = stamp_of(states.header_().stamp_());
  for (const msg::ComponentState& state : states.components_()) {
    const std::pair key{states.process_(), state.component_()};
    const auto before = components.find(key);
    components[key] =
        seen_after(before == components.end() ? std::nullopt : std::optional{before->second},
                   {.state = state, .stamp = stamp, .told = told, .heard = monotonic_now()});
  }
}

}  // namespace armature
