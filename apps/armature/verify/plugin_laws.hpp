// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "armature/laws/law.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
#include "verify.hpp"

namespace armature {

/// A law, ready to be checked on one plugin.
struct LawRun {
  std::string says;
  /// Makes the plugin anew. Throws when the plugin refuses to be made.
  std::function<LawReport()> check;
};

/// What its laws are checked with.
struct VerifiedPlugin {
  const VerifyOptions& options;
  std::vector<std::filesystem::path> search_path;
  std::string id;
  ArmChoice arm;            // no robot: its kind knows none
  std::string environment;  // what a shell must set to find the plugin again
};

/// The laws of one plugin. Only `refusal` and the checks run its code: to be called in a process
/// that may crash.
class PluginLaws {
 public:
  virtual ~PluginLaws() = default;

  /// Why it does not serve the robot; empty when it does.
  virtual std::string refusal() = 0;
  virtual std::vector<LawRun> laws() = 0;

  /// Forgets what the plugin was asked, then tells the last thing that it was asked, also by a
  /// process that has crashed meanwhile; empty when a law's own report says it.
  virtual void forget_question() {}
  virtual std::string last_question() const { return ""; }
  /// The shell command that asks again; empty when there is none.
  virtual std::string command_for(const std::string& /*question*/) const { return ""; }
};

/// True when plugins of its kind, or this component, are made for a robot.
bool is_made_for_robot(const PluginManifest& plugin);

/// Throws InvalidChoice when the plugin provides what is no promise of its kind, or when there are
/// no laws for it; config::ConfigError when the robot or the parameters are wrong.
std::unique_ptr<PluginLaws> laws_of(const VerifiedPlugin& verified);

/// The same for the kind `ik`.
std::unique_ptr<PluginLaws> laws_of_ik(const VerifiedPlugin& verified);
/// The same for a component, unit by unit.
std::unique_ptr<PluginLaws> laws_of_component(const VerifiedPlugin& verified);

}  // namespace armature
