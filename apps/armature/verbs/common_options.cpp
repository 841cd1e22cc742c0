// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "verbs/option_checks.hpp"
#include "verbs/verbs.hpp"

namespace armature {

void add_interfaces(CLI::App& verb, std::vector<std::string>& interfaces) {
  verb.add_option("--interface", interfaces,
                  "join this one beside loopback, by name or IPv4 address")
      ->allow_extra_args(false)
      ->check(no_interface);
}

void add_arm(CLI::App* verb, ArmChoice& arm) {
  verb->add_option("--robot", arm.robot, "robot file, or URDF file (*.urdf) with --tip");
  verb->add_option("--tip", arm.tip,
                   "frame that goals are stated for, instead of 'tool'; of a URDF file a link");
  verb->add_option("--base", arm.base, "link of a URDF file that is the base (its root)");
}

}  // namespace armature
