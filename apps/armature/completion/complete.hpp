// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "completion/candidate.hpp"
#include "verbs/verb_tree.hpp"

namespace armature {

/// What the last of `words` may become (empty: a word that is not begun), those before it being
/// known: all after the program's name. None: a file, which the shell knows.
Candidates complete(const Verb& program, std::vector<std::string> words);

/// `armature __complete WORDS...`, which completion scripts ask: a candidate a line, with its
/// description after a tab.
int print_candidates(const Verb& program, const std::vector<std::string>& words);

}  // namespace armature
