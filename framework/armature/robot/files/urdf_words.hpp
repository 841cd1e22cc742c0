// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "armature/config/problems.hpp"

namespace tinyxml2 {
class XMLElement;
}

namespace armature {

/// Adds what urdfdom drops without a word, and takes a default for, in a <joint>: elements and
/// attributes that are nearly one of URDF, any unknown attribute of an <origin>, and a second
/// element of which only the first is read. Words of others, such as <hardwareInterface>, pass.
void check_joint_words(const tinyxml2::XMLElement& joint, const std::string& file,
                       config::Problems& problems);

}  // namespace armature
