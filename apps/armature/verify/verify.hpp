// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "arm_choice.hpp"

namespace armature {

struct VerifyOptions {
  std::string plugin;  // an id, or a library file
  ArmChoice arm;       // no robot: every one that came with this program and that the plugin serves
  std::string rig;     // file, for a component that uses one
  std::string params;  // YAML map
  int poses = 1000;    // of every set; of a component activations
  std::uint64_t seed = 1;
  double timeout_s = 300;  // for one law
  bool json = false;
};

/// `armature plugin verify`: every law of the plugin's kind, one line each; exit code 0 only when
/// all are kept. Each is checked in a process of its own, so that a crash is a line, too.
int verify_plugin(const VerifyOptions& options);

}  // namespace armature
