// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <random>
#include <vector>

#include "armature/messages/type_description.hpp"

namespace armature ARMATURE_EXPORT {

/// What stands in the floating-point fields of a message that is made by chance.
enum class RandomNumbers {
  finite,  // in [-2, 2], so that many are positions, angles and speeds as they occur
  any,     // NaN, infinities, 1e300, subnormal numbers and zeros among them
  none,    // NaN in every field
};

/// The CDR encoding of a message with random values: sequences of 0 to 8 elements,
/// most of them equally long, texts of 0 to 12
/// characters, integers over their range or small. Decodes as `type`.
std::vector<std::byte> random_message(const TypeDescription& type, RandomNumbers numbers,
                                      std::mt19937_64& random);

}  // namespace armature
