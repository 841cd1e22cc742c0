// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/runtime/deployment_file/deployment_config.hpp"

namespace armature ARMATURE_EXPORT {

/// Checks how the components of a deployment are wired and sets every component's place in the
/// graph (sources first; file order among equals). Problems: a topic with two writers that do not
/// both share it, two types, frames, robots or unmatchable QoS on one topic, an input nobody
/// writes (of `plugins` those that would are named), a cycle in which no input is declared as
/// feedback.
void check_graph(DeploymentConfig& deployment, const PluginRegistry& plugins,
                 config::Problems& problems);

/// The port of that name; null: there is none.
const PortBinding* find_port(const std::vector<PortBinding>& ports, std::string_view name);
/// Whether one of the ports is on that topic.
bool has_topic(const std::vector<PortBinding>& ports, std::string_view topic);
/// The first one that writes that topic; null: nobody does.
const ComponentConfig* writer_of(std::string_view topic, const DeploymentConfig& deployment);
bool reads_from(const ComponentConfig& reader, const ComponentConfig& writer);
/// Whether one of them reads what the other one writes.
bool exchange_topics(const ComponentConfig& a, const ComponentConfig& b);

}  // namespace armature
