// SPDX-License-Identifier: Apache-2.0
#include "verbs/verb_tree.hpp"

#include <CLI/CLI.hpp>

namespace armature {
namespace {

/// "{bash,zsh}" at the end of the text of a type, as CLI::IsMember writes it.
std::vector<std::string> choices_of(const std::string& type) {
  const std::size_t begin = type.find('{');
  if (begin == std::string::npos || !type.ends_with('}')) return {};
  return CLI::detail::split(type.substr(begin + 1, type.size() - begin - 2), ',');
}

VerbOption option_of(const CLI::Option& option) {
  VerbOption told;
  for (const std::string& name : option.get_snames()) told.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) told.names.push_back("--" + name);
  if (option.get_positional()) told.names = {option.get_name(true)};
  const int most = option.get_items_expected_max();
  // A list without end takes one word at a time.
  told.values = most >= CLI::detail::expected_max_vector_size ? 1 : most;
  if (told.values > 0) told.type = option.get_type_name();
  told.description = option.get_description();
  told.required = option.get_required();
  told.choices = choices_of(told.type);
  return told;
}

}  // namespace

Verb verb_tree(const CLI::App& app) {
  Verb verb{.name = app.get_name(), .description = app.get_description()};
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;
    (option->get_positional() ? verb.positionals : verb.options).push_back(option_of(*option));
  }
  for (const CLI::App* below : app.get_subcommands(nullptr)) {
    if (!below->get_group().empty()) verb.verbs.push_back(verb_tree(*below));
  }
  return verb;
}

}  // namespace armature
