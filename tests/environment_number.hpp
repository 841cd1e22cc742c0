// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>

namespace armature::test {

/// The number that an environment variable tells, as of the first seed; else `without`.
inline int environment_number(const char* variable, int without) {
  const char* told = std::getenv(variable);
  return told ? std::atoi(told) : without;
}

}  // namespace armature::test
