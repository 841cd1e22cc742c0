// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace armature::bench {

/// Where and with what figures were measured.
struct Machine {
  std::string processor;  // "AMD EPYC 9575F 64-Core Processor"
  int processors = 0;     // that this process may use
  std::string system;     // "Linux 6.1.0-18-amd64"
  std::string compiler;   // "GCC 12.2.0, -O2 -DNDEBUG"
  double load = 0;        // how many others were running: the load average of the last minute
};
Machine this_machine();

nlohmann::ordered_json to_json(const Machine& machine);
/// In one line.
std::string to_text(const Machine& machine);

}  // namespace armature::bench
