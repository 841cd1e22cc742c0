// SPDX-License-Identifier: Apache-2.0
#include "completion/complete.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "armature/runtime/plugins/plugin_registry.hpp"
#include "completion/assignment.hpp"
#include "exit_code.hpp"
#include "plugin_new/family.hpp"
#include "standard_output.hpp"
#include "verbs/shipped_configs.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;

/// Where the last word stands, as the words before it say.
struct Place {
  const Verb* verb;
  const VerbOption* awaits = nullptr;  // the option whose value it is
  DeploymentSource source;             // positional words, and --set, so far
};

const VerbOption* option_named(const std::string& name, const Verb& verb) {
  const auto found = std::ranges::find_if(verb.options, [&](const VerbOption& option) {
    return std::ranges::find(option.names, name) != option.names.end();
  });
  return found == verb.options.end() ? nullptr : &*found;
}

Place place_after(const std::vector<std::string>& words, const Verb& program) {
  Place place{.verb = &program};
  int values_left = 0;
  for (const std::string& word : words) {
    if (values_left > 0) {
      if (place.awaits->names.back() == "--set") place.source.assignments.push_back(word);
      if (--values_left == 0) place.awaits = nullptr;
      continue;
    }
    if (word.starts_with('-')) {
      const VerbOption* option = option_named(word, *place.verb);
      values_left = option ? option->values : 0;
      if (values_left > 0) place.awaits = option;
      continue;
    }
    const auto below = std::ranges::find(place.verb->verbs, word, &Verb::name);
    if (below != place.verb->verbs.end()) {
      place.verb = &*below;
    } else {
      place.source.files.emplace_back(word);
    }
  }
  return place;
}

/// The shipped deployments, and what lies in the folder that `typed` begins with; hidden
/// ones when a name is begun.
Candidates deployment_files(const std::string& typed) {
  Candidates all;
  for (const fs::path& file : shipped_deployments()) {
    all.push_back({file.stem(), "came with armature"});
  }
  const std::string folder = typed.substr(0, typed.rfind('/') + 1);
  std::error_code error;
  Candidates here;
  for (const auto& entry : fs::directory_iterator{folder.empty() ? "." : folder, error}) {
    const std::string file = entry.path().filename();
    if (file.starts_with('.') && folder.size() == typed.size()) continue;
    const std::string name = folder + file;
    if (entry.is_directory(error)) here.push_back({name + "/", ""});
    if (entry.path().extension() == ".yaml") here.push_back({name, ""});
  }
  std::ranges::sort(here, {}, &Candidate::text);
  std::ranges::move(here, std::back_inserter(all));
  return all;
}

/// After the last comma of a list of ids.
Candidates plugin_ids(const std::string& typed) {
  const std::string before = typed.substr(0, typed.rfind(',') + 1);
  const PluginRegistry registry;
  Candidates all;
  for (const auto& plugin : registry.plugins()) all.push_back({before + plugin.id, plugin.doc});
  return all;
}

/// Families that a new plugin may be of; its name is free.
Candidates plugin_families() {
  Candidates all;
  for (const std::string& family : family_names()) all.push_back({family + '/', ""});
  return all;
}

/// The values of an option or of a positional word. None: files.
Candidates values_of(const VerbOption& option, const Place& place, const std::string& typed) {
  const std::string& name = option.names.back();
  if (name == "--set") return assignments(place.source, typed);
  if (name == "files") return deployment_files(typed);
  if (name == "id" && place.verb->name == "new") return plugin_families();
  for (const char* of_plugins : {"--plugin", "--plugins", "plugin", "id"}) {
    if (name == of_plugins) return plugin_ids(typed);
  }
  Candidates all;
  for (const std::string& choice : option.choices) all.push_back({choice, ""});
  return all;
}

Candidates options_of(const Verb& verb) {
  Candidates all;
  for (const VerbOption& option : verb.options) {
    all.push_back({option.names.back(), option.description});
  }
  return all;
}

Candidates candidates_at(const Place& place, const std::string& typed) {
  if (place.awaits) return values_of(*place.awaits, place, typed);
  if (typed.starts_with('-')) return options_of(*place.verb);
  Candidates all;
  for (const Verb& below : place.verb->verbs) all.push_back({below.name, below.description});
  const auto& positionals = place.verb->positionals;
  if (all.empty() && !positionals.empty()) {
    const std::size_t which = std::min(place.source.files.size(), positionals.size() - 1);
    all = values_of(positionals[which], place, typed);
  }
  return all;
}

}  // namespace

Candidates complete(const Verb& program, std::vector<std::string> words) {
  if (words.size() > 1 && words.front() == "help") words.erase(words.begin());
  if (words.empty()) words.emplace_back();
  const std::string typed = words.back();
  words.pop_back();
  Candidates all = candidates_at(place_after(words, program), typed);
  std::erase_if(all, [&](const Candidate& one) { return !one.text.starts_with(typed); });
  return all;
}

int print_candidates(const Verb& program, const std::vector<std::string>& words) {
  for (const auto& [text, description] : complete(program, words)) {
    print_out("{}\t{}\n", text, description);
  }
  return kOk;
}

}  // namespace armature
