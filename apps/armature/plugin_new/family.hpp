// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace armature {

/// Plugins that begin in the same way, the first half of their ids: "ik", "camera". Its template is
/// a folder: the files of a new plugin, and family.yaml, which is what is read here.
struct PluginFamily {
  std::string doc;                 // one line of `armature plugin new --help`
  std::vector<std::string> links;  // libraries, without "Armature::"
  bool robot = false;              // comes with arm.yaml and arm.urdf
  std::vector<std::string> runs;   // commands of its README
  std::vector<std::pair<std::string, std::string>> files;  // beside those that every plugin has
};

/// The folders of templates that came with this program, one per family, and what is `common`.
std::filesystem::path template_folder();

/// All families, sorted.
std::vector<std::string> family_names();

/// What the family's family.yaml says once `fill` has put a plugin's names into it.
PluginFamily read_family(const std::string& name,
                         const std::function<std::string(std::string)>& fill);

/// A line for each family: for the help.
std::string family_table();

}  // namespace armature
