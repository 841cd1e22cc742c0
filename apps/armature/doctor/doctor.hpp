// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace armature {

/// `armature doctor`: what this machine lacks for a deployment, with the way out. Fails when there
/// is a problem; warnings are allowed.
int examine_machine(bool json);

}  // namespace armature
