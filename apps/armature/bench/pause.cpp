// SPDX-License-Identifier: Apache-2.0
#include "bench/pause.hpp"

#include <stdexcept>

#include "watch/outsider.hpp"

namespace armature::bench {

void pause_s(double seconds) {
  if (!wait_for(armature::seconds(seconds))) throw std::runtime_error{"interrupted"};
}

}  // namespace armature::bench
