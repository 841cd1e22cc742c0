// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "completion/script.hpp"
#include "doctor/doctor.hpp"
#include "exit_code.hpp"
#include "standard_output.hpp"
#include "verbs/man_page.hpp"
#include "verbs/verb_tree.hpp"
#include "verbs/verbs.hpp"

namespace armature {
namespace {

void add_doctor(CLI::App& app, Action& action) {
  auto json = std::make_shared<bool>(false);
  CLI::App* doctor =
      app.add_subcommand("doctor", "What this machine lacks for a deployment, with the way out");
  doctor->add_flag("--json", *json, "as JSON");
  doctor->callback([=, &action] { action = [=] { return examine_machine(*json); }; });
}

/// What shells and man(1) want to know of all the verbs.
void add_words(CLI::App& app, Action& action) {
  auto shell = std::make_shared<std::string>();
  CLI::App* completion = app.add_subcommand(
      "completion", "Print what completes a line: eval \"$(armature completion bash)\"");
  completion->add_option("shell", *shell, "whose script")
      ->required()
      ->check(CLI::IsMember(std::vector<std::string>{"bash", "zsh", "fish"}));
  completion->callback([=, &action] { action = [=] { return print_completion(*shell); }; });

  CLI::App* man = app.add_subcommand("man", "Print this help as a manual page (roff)");
  man->callback([&app, &action] {
    action = [&app] {
      print_out("{}", man_page(verb_tree(app), ARMATURE_VERSION));
      return kOk;
    };
  });
}

}  // namespace

void add_machine_verbs(CLI::App& app, Action& action) {
  add_doctor(app, action);
  add_words(app, action);
}

}  // namespace armature
