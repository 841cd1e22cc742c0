// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "doctor/facts.hpp"

namespace armature::doctor {

enum class Level {
  ok,
  warning,  // everything runs, something less well
  problem,  // something does not run
};
std::string_view to_string(Level level);

/// One line of the report.
struct Finding {
  Level level = Level::ok;
  std::string what;     // was looked at: "free shared memory"
  std::string value;    // "7900 MiB"
  std::string meaning;  // for whoever runs a deployment
  std::string hint;     // a command that can be copied; empty when nothing is to be done
};

/// What the facts mean, in their order.
std::vector<Finding> judge(const Facts& facts);

}  // namespace armature::doctor
