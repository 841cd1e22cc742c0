// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace armature::bench {

/// Reads all topics of the `armature monitor` at that port of this machine, as a page does that
/// shows them all, until it ends. Returns the exit code: 1 when there is no monitor.
int read_as_a_page(int port);

}  // namespace armature::bench
