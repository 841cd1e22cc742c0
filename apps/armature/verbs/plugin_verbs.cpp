// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "inspect/plugins.hpp"
#include "plugin_new/family.hpp"
#include "verbs/verbs.hpp"
#include "verify/verify.hpp"

namespace armature {
namespace {

void add_verify(CLI::App& plugin, Action& action) {
  auto options = std::make_shared<VerifyOptions>();
  CLI::App* verify = plugin.add_subcommand("verify", "Check every law of the plugin's kind");
  verify->add_option("plugin", options->plugin, "its id, or a library file")->required();
  add_arm(verify, options->arm);
  verify->add_option("--params", options->params, "the plugin's parameters, a YAML map");
  verify->add_option("--rig", options->rig, "rig file, for a component that uses one");
  add_ranged(verify, "--poses", options->poses, "of every set; of a component its activations", 1,
             1000000);
  add_seed(verify, options->seed, "of the random numbers");
  add_ranged(verify, "--timeout", options->timeout_s,
             "seconds that a law may take; a solver that hangs breaks it", 0.1, 1e6);
  verify->add_flag("--json", options->json, "as JSON");
  verify->callback([options, &action] { action = [options] { return verify_plugin(*options); }; });
}

}  // namespace

void add_plugin_verbs(CLI::App& app, Action& action) {
  CLI::App* plugin = app.add_subcommand("plugin", "List, describe, start and verify plugins");
  plugin->require_subcommand(1);
  auto json = std::make_shared<bool>(false);
  auto id = std::make_shared<std::string>();
  auto directory = std::make_shared<std::string>();

  CLI::App* list = plugin->add_subcommand("list", "Every plugin that is found");
  list->add_flag("--json", *json, "as JSON");
  list->callback([=, &action] { action = [=] { return list_plugins(*json); }; });

  CLI::App* info = plugin->add_subcommand("info", "What one plugin takes and gives");
  info->add_option("id", *id, "e.g. ik/numeric")->required();
  info->add_flag("--json", *json, "as JSON");
  info->callback([=, &action] { action = [=] { return show_plugin(*id, *json); }; });

  CLI::App* fresh = plugin->add_subcommand("new", "Write a complete small plugin to start from");
  fresh->add_option("id", *id, "family/name, e.g. ik/mine")->required();
  fresh->add_option("-o,--output", *directory, "folder to write it into")->required();
  fresh->footer(family_table);
  fresh->callback([=, &action] { action = [=] { return new_plugin(*id, *directory); }; });

  add_verify(*plugin, action);
}

}  // namespace armature
