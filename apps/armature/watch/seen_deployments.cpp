// SPDX-License-Identifier: Apache-2.0
#include "watch/seen_deployments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "armature/bus/topic_name.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/values/monotonic_now.hpp"

namespace armature {
namespace {

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

/// What the topic tells of which deployment, where that writes it; who else does is noted.
std::optional<SeenDeployments::OwnTopic> SeenDeployments::own_topic(const ObservedTopic& topic) {
  const std::string described = deployment_of(topic.name, "description");
  const std::string told = deployment_of(topic.name, "component_states");
  const OwnTopic own{.deployment = described.empty() ? told : described,
                     .describes = !described.empty()};
  if (own.deployment.empty() || (!name_.empty() && own.deployment != name_)) return std::nullopt;
  const MessageType& type = own.describes ? message_type<msg::DeploymentDescription>()
                                          : message_type<msg::ComponentStates>();
  const auto is_own = [&](const ObservedEndpoint& endpoint) {
    return endpoint.writes && endpoint.deployment == own.deployment &&
           endpoint.type == type.dds_name;
  };
  const bool has_own = std::ranges::any_of(topic.endpoints, is_own);
  for (const ObservedEndpoint& endpoint : topic.endpoints) {
    // A topic of this name with another type, where no deployment is, is nothing to note.
    const bool is_like = has_own || endpoint.type == type.dds_name;
    if (!endpoint.writes || is_own(endpoint) || !is_like) continue;
    note(endpoint.owner + " " + topic.name,
         fmt::format("a writer of {} writes '{}' and is no part of deployment '{}' that this "
                     "program knows: what it tells is not taken",
                     endpoint.owner, ros_topic_name(topic.name), own.deployment));
  }
  return has_own ? std::optional{own} : std::nullopt;
}

void SeenDeployments::look() {
  std::set<std::string> there;
  for (const ObservedTopic& topic : outsider_.dds().topics()) {
    const auto own = own_topic(topic);
    if (!own) continue;
    there.insert(own->deployment);
    if (!watched_.contains(topic.name)) watch(topic.name, *own);
  }
  const std::scoped_lock lock{mutex_};
  std::erase_if(seen_, [&](const auto& entry) { return !there.contains(entry.first); });
}

void SeenDeployments::watch(const std::string& topic, const OwnTopic& own) {
  const auto watching =
      outsider_.dds().watch(topic, Duration{0}, [=, this](const ObservedSample& sample) {
        if (!sample.writer || sample.writer->deployment != own.deployment) return;
        if (!own.describes) {
          if (const auto states = decoded<msg::ComponentStates>(sample)) {
            add(own.deployment, *states, sample.source);
          }
        } else if (const auto description = decoded<msg::DeploymentDescription>(sample)) {
          add(own.deployment, *description, sample.writer->owner);
        }
      });
  if (watching) watched_.insert(topic);
}

std::map<std::string, SeenDeployment> SeenDeployments::all() const {
  const std::scoped_lock lock{mutex_};
  return seen_;
}

std::vector<std::string> SeenDeployments::notes() const {
  const std::scoped_lock lock{mutex_};
  return notes_;
}

void SeenDeployments::note(const std::string& who, const std::string& what) {
  constexpr std::size_t kMostNotes = 100;
  const std::scoped_lock lock{mutex_};
  if (notes_.size() < kMostNotes && noted_.insert(who).second) notes_.push_back(what);
}

void SeenDeployments::add(const std::string& deployment,
                          const msg::DeploymentDescription& description,
                          const std::string& writer) {
  if (description.deployment_() != deployment) {
    return note(writer + " as another", fmt::format("a writer of {} describes deployment '{}' on "
                                                    "the topic of '{}': that is not taken",
                                                    writer, description.deployment_(), deployment));
  }
  const std::scoped_lock lock{mutex_};
  SeenDeployment& seen = seen_[deployment];
  const bool another_run =
      !seen.processes.empty() && seen.processes.begin()->second.run_() != description.run_();
  if (another_run) seen = {};
  seen.processes[description.process_()] = description;
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
