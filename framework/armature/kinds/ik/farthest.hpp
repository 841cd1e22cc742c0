// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace armature ARMATURE_EXPORT {

/// The largest position [m], joint or redundancy [rad or m] that is taken for one: beyond it sums
/// of squares would soon be infinite.
inline constexpr double kFarthest = 1e100;

}  // namespace armature
