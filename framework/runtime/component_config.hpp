// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "armature/config/reader.hpp"
#include "armature/runtime/deployment_config.hpp"

namespace armature {

/// Reads one entry of `components:` against the manifests of the plugins it names.
class ComponentReader {
 public:
  using DocumentSections = std::span<const std::pair<std::string_view, std::string_view>>;

  ComponentReader(const DeploymentConfig& deployment, const PluginRegistry& plugins,
                  DocumentSections sections, config::Problems& problems)
      : deployment_{deployment}, plugins_{plugins}, sections_{sections}, problems_{problems} {}

  /// Nothing when its plugin is unknown: nothing else can be said of it then.
  std::optional<ComponentConfig> read(const config::Node::Entry& entry) const;

 private:
  const PluginManifest* find_plugin(const std::string& id, const config::Origin& origin) const;
  void report_missing_plugin(const config::Node::Entry& entry) const;
  void read_params(config::MapReader& map, const PluginManifest& named,
                   ComponentConfig& component) const;
  void read_slots(config::MapReader& map, ComponentConfig& component) const;
  void read_slot(const SlotSpec& spec, const config::Node& node, ComponentConfig& component) const;
  void bind_documents(config::MapReader& map, ComponentConfig& component) const;
  void bind_ports(const config::Node* renames, std::string_view direction,
                  const std::vector<PortSpec>& specs, const ComponentConfig& component,
                  std::vector<PortBinding>& bindings) const;

  const DeploymentConfig& deployment_;
  const PluginRegistry& plugins_;
  DocumentSections sections_;
  config::Problems& problems_;
};

}  // namespace armature
