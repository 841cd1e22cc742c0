// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <urdf_world/types.h>

#include <filesystem>
#include <map>
#include <string>

#include "armature/config/node.hpp"

namespace armature {

/// A URDF file as urdfdom reads it, and where it says what: urdfdom itself keeps no lines.
class UrdfDocument {
 public:
  /// `named_at`: where the file is named. Throws config::ConfigError: the file cannot be read, is
  /// no XML, or urdfdom refuses it (its own messages, at the joint or link that they name), or
  /// would drop something of a joint.
  static UrdfDocument load(const std::filesystem::path& file, const config::Origin& named_at);

  const urdf::ModelInterface& model() const { return *model_; }
  /// The file, without a line.
  const std::string& file() const { return file_; }
  /// Where a joint is written.
  config::Origin joint(const std::string& name) const;

 private:
  using Places = std::map<std::string, config::Origin>;  // by the name of a joint or link

  static Places places_in(const std::string& text, const std::string& file);

  std::string file_;
  urdf::ModelInterfaceSharedPtr model_;
  Places places_;
};

}  // namespace armature
