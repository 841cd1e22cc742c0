// SPDX-License-Identifier: Apache-2.0
// The command line, as a whole; its verbs stand in verbs/.
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "armature/config/problems.hpp"
#include "bench/program.hpp"
#include "completion/complete.hpp"
#include "exit_code.hpp"
#include "standard_output.hpp"
#include "verbs/verb_tree.hpp"
#include "verbs/verbs.hpp"

namespace armature {
namespace {

/// What is wrong with the verbs at the beginning of the line; empty: nothing.
std::string unknown_verb(const CLI::App& app, const std::vector<std::string>& line) {
  const CLI::App* verb = &app;
  for (const std::string& word : line) {
    if (verb->get_require_subcommand_min() == 0 || word.starts_with('-')) return "";
    const CLI::App* next = nullptr;
    std::vector<std::string> names;
    for (const CLI::App* known : verb->get_subcommands(nullptr)) {
      if (known->get_name() == word) next = known;
      names.push_back(known->get_name());
    }
    if (!next) {
      return fmt::format("'{}' has no verb {}{}", verb->get_name(), config::in_quotes(word),
                         config::did_you_mean(word, names));
    }
    verb = next;
  }
  return "";
}

/// The words of a command line, "help run" as "run --help".
std::vector<std::string> words_of(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  if (words.empty() || words.front() != "help") return words;
  words.erase(words.begin());
  words.push_back("--help");
  return words;
}

int run_command_line(int argc, char** argv) {
  bench::end_with_bench();
  CLI::App app{
      "Config-driven robot systems over DDS.\n\n"
      "Example: armature run configs/dental_lamp.yaml --set "
      "components.motion.ik.plugin=ik/numeric"};
  app.name("armature");
  app.require_subcommand(1);
  app.set_version_flag("--version", "armature " ARMATURE_VERSION, "Print the version");
  app.add_subcommand("help", "What a verb does, and its options: armature help run");
  Action action;
  add_deployment_verbs(app, action);
  add_plugin_verbs(app, action);
  add_watch_verbs(app, action);
  add_record_verbs(app, action);
  add_arm_verbs(app, action);
  add_bench_verbs(app, action);
  add_paper_verbs(app, action);
  add_machine_verbs(app, action);
  std::vector<std::string> words = words_of(argc, argv);
  if (!words.empty() && words.front() == "__complete") {
    return exit_code_of([&] {
      return print_candidates(verb_tree(app), {words.begin() + 1, words.end()});
    });
  }
  if (const std::string wrong = unknown_verb(app, words); !wrong.empty()) {
    fmt::print(stderr, "{}\n", wrong);
    return kUsage;
  }
  std::ranges::reverse(words);  // as CLI11 wants them
  try {
    app.parse(words);
  } catch (const CLI::ParseError& error) {
    std::ostringstream help;
    if (app.exit(error, help, std::cerr) != 0) return kUsage;
    return exit_code_of([&] {
      print_out("{}", help.str());
      return kOk;
    });
  }
  return exit_code_of(action);
}

}  // namespace
}  // namespace armature

/// Standard streams that the caller has closed: else the next files that are opened would be them.
/// What is written to one of them then fails.
void hold_standard_streams() {
  int file = 0;
  do {
    file = open("/dev/null", O_RDONLY);
  } while (file >= 0 && file <= STDERR_FILENO);
  if (file > STDERR_FILENO) close(file);
}

int main(int argc, char** argv) {
  hold_standard_streams();
  // Whose parent ignores the ends of children would not be told how its own end.
  std::signal(SIGCHLD, SIG_DFL);
  std::ios::sync_with_stdio(false);
  return armature::run_command_line(argc, argv);
}
