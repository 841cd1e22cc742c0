// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace armature ARMATURE_EXPORT {

/// `name` as C++ takes it: a keyword, or a name that generated code uses itself, gets a '_' behind.
std::string in_cpp(std::string_view name);

/// The namespace of a plugin: "armature::task::lamp_alignment" of "task/lamp_alignment".
std::string namespace_of(std::string_view id);

/// Whether `c` may be in a name of C++.
bool is_in_a_name(char c);

}  // namespace armature
