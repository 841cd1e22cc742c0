// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "armature/config/node.hpp"
#include "armature/config/params.hpp"
#include "armature/config/problems.hpp"

namespace armature ARMATURE_EXPORT {

/// The C++ header of a plugin's `struct Parameters`, made from its plugin.yaml: one member for each
/// parameter, typed, in SI units and named without its unit, with its `doc` and its default, and a
/// function that reads them. The struct stands in a namespace of the plugin's id:
/// `armature::task::lamp_alignment`.
///
/// Two parameters that differ in their unit only keep it: `curve_m` and `curve_hz`. A choice
/// becomes an `enum class`. What cannot be a name in C++ is noted in `problems`.
std::string parameters_header(const config::Node& manifest, config::Problems& problems);

/// Notes a problem when plugin.yaml is of another format, or has another id than `id`, that of
/// armature_add_plugin(), by which the plugin's code finds the struct.
void check_plugin(const config::Node& manifest, const std::string& id, config::Problems& problems);

/// The names of the struct's members, in the order of the file.
std::vector<std::string> parameter_members(const std::vector<ParamSpec>& specs);

}  // namespace armature
