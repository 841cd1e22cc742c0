// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace armature {

/// armature schema: the JSON Schema of deployments with the plugins that are found, for editors. It
/// judges what is written, and `armature check` what is missing: a file may be an overlay.
int print_schema();

}  // namespace armature
