// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace armature {

/// A file of a new plugin. In its name and its text @ID@, @NAME@, @CLASS@, @TARGET@, @PACKAGE@ and
/// @CONFIGS@ are filled in.
struct TemplateFile {
  std::string_view name, text;
};

/// What `armature plugin new` writes for `family`/name, besides the arm to try it with.
struct PluginTemplate {
  std::string_view family;
  std::string_view class_ending;  // behind the name in @CLASS@
  std::span<const TemplateFile> files;
};

const PluginTemplate& arm_template();
const PluginTemplate& ik_template();

}  // namespace armature
