// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace armature {
namespace config ARMATURE_EXPORT {

/// The unit that the end of a key states: `tilt_deg`, `max_velocity_mm_s`.
struct UnitSuffix {
  std::string_view written;  // without the underline before it: "deg"
  double to_si = 1;          // factor
  std::string_view si;       // what it is then: "rad"
};

/// Null for a key that states no unit, or one that is not known.
const UnitSuffix* unit_of(std::string_view key);

/// `key` without its unit, known or not: "tilt".
std::string_view without_unit(std::string_view key);

/// The factor from a key's unit to SI: `_deg` -> pi/180, `_mm` -> 1e-3; 1 for a key without unit.
double si_factor(std::string_view key);

/// What is wrong with a key that ends in a unit which is not known, `width_cm` or `rate_deg_min`;
/// empty: nothing. The text begins with that end, and names what may stand there.
std::string unknown_unit(std::string_view key);

}  // namespace config
}  // namespace armature
