// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

namespace armature::bench {

/// Two processors that this process may use. Throws std::runtime_error when it may use one only.
std::pair<int, int> two_cpus();

/// Moves the calling thread, and what it starts from then on, to a processor.
void move_to_cpu(int cpu);

}  // namespace armature::bench
