// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "verbs/verb_tree.hpp"

namespace armature {

/// The manual page (roff, for man(7)) of a program, from the text of its --help.
std::string man_page(const Verb& program, const std::string& version);

}  // namespace armature
