// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace armature {

/// `armature completion SHELL`: a script for bash, zsh or fish. It knows no verb: it asks the
/// program.
int print_completion(const std::string& shell);

}  // namespace armature
