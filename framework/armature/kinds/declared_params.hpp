// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "armature/config/document.hpp"
#include "armature/config/params.hpp"

namespace armature ARMATURE_EXPORT {

/// The parameters that a `plugin.yaml` declares, with those of the YAML map `given` in place of
/// their defaults: for tests and tools that make a plugin's class themselves. Throws
/// config::ConfigError.
inline Params declared_params(const std::filesystem::path& plugin_yaml,
                              std::string_view given = {}) {
  const config::Node manifest = config::parse_file(plugin_yaml);
  const config::Node* table = manifest.find("params");
  config::Problems problems;
  const auto specs = table ? read_param_specs(*table, problems) : std::vector<ParamSpec>{};
  const config::Node values = config::parse_text(given, "given");
  const config::Node* id = manifest.find("id");
  const bool none = values.kind() == config::Node::Kind::null;
  Params params = Params::read(specs, none ? nullptr : &values, id ? id->text() : "", problems);
  problems.throw_if_any();
  return params;
}

}  // namespace armature
