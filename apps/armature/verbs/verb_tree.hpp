// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace armature {

/// An option or a positional word of a verb, as --help tells it.
struct VerbOption {
  std::vector<std::string> names;  // "-o", "--output"; of a positional its one name: "files"
  std::string type;                // "TEXT", "INT:INT in [0 - 232]"; empty: a flag
  std::string description;
  int values = 0;  // that follow it; of a positional one or many
  bool required = false;
  std::vector<std::string> choices;  // when it takes only these
};

/// A verb of the command line, or the program itself.
struct Verb {
  std::string name, description;
  std::vector<VerbOption> options, positionals;  // but for hidden ones
  std::vector<Verb> verbs;
};

Verb verb_tree(const CLI::App& app);

}  // namespace armature
