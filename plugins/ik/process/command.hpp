// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "armature/values/expected.hpp"

namespace armature::ik::process {

/// A program to start, with its arguments.
struct Command {
  std::vector<std::string> words;  // the first names the program
  std::string file;                // which that was found to be
  std::string folder;              // where it runs; empty: where we do

  /// "python3 solver.py", cut where it gets long.
  std::string text() const;
};

/// Finds the program of `words`: in the folders of $PATH, or from `folder` when its name has a '/'.
/// Refuses what is not there or cannot be executed, and tells where it was looked for.
Expected<Command> find_command(std::vector<std::string> words, std::string folder);

}  // namespace armature::ik::process
