// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace armature::bench {

/// Waits. Throws std::runtime_error, so that what the bench has started ends with it, as soon as it
/// is interrupted (leave_in_order()).
void pause_s(double seconds);

}  // namespace armature::bench
