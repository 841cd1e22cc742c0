// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "command.hpp"

namespace armature::test {

/// The robot that most commands are tried with.
inline const std::string kLamp = source_file("configs/robots/dental_lamp.yaml");

}  // namespace armature::test
