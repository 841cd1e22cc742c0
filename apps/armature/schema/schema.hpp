// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace armature {

/// armature schema [deployment|robot|rig]: the JSON Schema of such files, for editors; that of
/// deployments has the plugins that are found. It judges what is written, and `armature check` what
/// is missing: a file may be an overlay.
int print_schema(const std::string& of);

}  // namespace armature
