// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "armature/config/reader.hpp"
#include "armature/runtime/deployment_file/deployment_config.hpp"
#include "armature/runtime/deployment_file/deployment_keys.hpp"

namespace armature ARMATURE_EXPORT {

/// What is wrong with the name of a deployment, a process or a host, or nothing: it consists of at
/// most 64 letters, digits and '_', and begins with no digit. It becomes a part of names in DDS,
/// which Fast DDS holds in 255 bytes.
std::optional<std::string> name_defect(std::string_view name);

/// Reads one entry of `components:` against the manifests of the plugins it names.
class ComponentReader {
 public:
  /// `deployment` has its name, documents and executors.
  ComponentReader(const DeploymentConfig& deployment, const PluginRegistry& plugins,
                  config::Problems& problems)
      : deployment_{deployment}, plugins_{plugins}, problems_{problems} {}

  /// Nothing when its plugin is unknown: nothing else can be said of it then.
  std::optional<ComponentConfig> read(const config::Node::Entry& entry) const;

 private:
  /// Noted at `origin`: an id that nobody has, and one that the deployment's clock rules out.
  const PluginManifest* find_plugin(const std::string& id, const config::Origin& origin) const;
  void report_missing_plugin(const config::Node::Entry& entry) const;
  void read_params(config::MapReader& map, const PluginManifest& named,
                   ComponentConfig& component) const;
  void read_slots(config::MapReader& map, ComponentConfig& component) const;
  void read_slot(const SlotSpec& spec, const config::Node& node, ComponentConfig& component) const;
  struct DocumentUse {
    std::string_view section, word;  // "robots", "robot"
    bool needed;                     // `uses:`, not `may_use:`
  };
  void bind_documents(config::MapReader& map, ComponentConfig& component) const;
  void bind_document(const DocumentUse& use, const config::Node* named,
                     ComponentConfig& component) const;
  void bind_ports(const config::Node* renames, std::string_view direction,
                  const std::vector<PortSpec>& specs, const ComponentConfig& component,
                  std::vector<PortBinding>& bindings) const;
  std::string topic_named(const config::Node& node, std::string_view what,
                          const std::string& otherwise) const;

  const DeploymentConfig& deployment_;
  const PluginRegistry& plugins_;
  config::Problems& problems_;
};

}  // namespace armature
