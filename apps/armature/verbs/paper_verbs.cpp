// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <memory>

#include "reproduce/reproduce.hpp"
#include "verbs/option_checks.hpp"
#include "verbs/verbs.hpp"

namespace armature {

void add_paper_verbs(CLI::App& app, Action& action) {
  auto options = std::make_shared<ReproduceOptions>();
  CLI::App* reproduce = app.add_subcommand(
      "reproduce",
      "Tables and figures of a paper beside ours: armature reproduce lamp --out figures");
  reproduce->add_option("paper", options->paper, "lamp, sr1, implant or master")->required();
  reproduce
      ->add_option("--out", options->out,
                   "folder for a CSV of each table, a CSV and an SVG of each figure")
      ->check(no_name);
  reproduce->add_flag("--short", options->is_short, "without what takes more than a few seconds");
  reproduce->add_flag("--json", options->json, "as JSON");
  reproduce->callback(
      [options, &action] { action = [options] { return reproduce_paper(*options); }; });
}

}  // namespace armature
