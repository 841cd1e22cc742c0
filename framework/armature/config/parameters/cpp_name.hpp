// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace armature ARMATURE_EXPORT {

/// `name` as C++ takes it: what cannot be in a name becomes a '_', and a keyword, or a name that
/// generated code uses itself, gets one behind.
std::string in_cpp(std::string_view name);

/// The namespace of a plugin: "armature::task::lamp_alignment" of "task/lamp_alignment".
std::string namespace_of(std::string_view id);

/// Whether `c` may be in a name of C++.
bool is_in_a_name(char c);

/// "InterpolationRule" of "interpolation_rule".
std::string camel_case(std::string_view name);

/// A text as a C++ literal.
std::string literal_of(std::string_view text);

/// A member's comment, on a line of its own; "" of no text.
std::string comment_of(std::string text);

}  // namespace armature
