// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "armature/messages/armature_msgs.hpp"

namespace armature {

/// The step that waits for its confirmation, or "".
std::string step_that_asks(const msg::TaskState& state);

/// All that ask when their turn comes, in their order.
std::vector<std::string> steps_with_question(const msg::TaskState& state);

/// What an operator reads of a task: what it does, and its steps, a line each.
std::string table_of(const msg::TaskState& state);

/// The same in one line, to see whether anything has changed.
std::string summary_of(const msg::TaskState& state);

nlohmann::ordered_json json_of(const msg::TaskState& state);

/// The word that `typed` means: it, or its first letter ("c": confirm); "" for none.
std::string word_of(const std::string& typed);

}  // namespace armature
