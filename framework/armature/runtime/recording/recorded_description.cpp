// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/recording/recorded_description.hpp"

#include <utility>

namespace armature {

void attach_description(const msg::DeploymentDescription& description, Time at, McapQueue& queue) {
  const auto attach = [&](const std::string& name, const std::string& text) {
    queue.attach({.log_time = at,
                  .create_time = at,
                  .name = description.deployment_() + "/" + name + ".yaml",
                  .media_type = "application/yaml",
                  .data = text});
  };
  std::map<std::string, std::string> values{
      {"deployment", description.deployment_()},
      {"fingerprint", description.fingerprint_()},
      {"run", description.run_()},
      {"version", description.version_()},
      {"clock", description.simulated_() ? "simulated" : "system"}};
  attach(description.deployment_(), description.configuration_());
  for (const auto& document : description.documents_()) {
    const std::string name = document.section_() + "/" + document.name_();
    attach(name, document.text_());
    values["file of " + name] = document.file_();
  }
  queue.add(McapMetadata{.name = std::string{kDeploymentMetadata}, .values = std::move(values)});
}

}  // namespace armature
