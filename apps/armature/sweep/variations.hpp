// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace armature::sweep {

/// "1..200", "3" or "1,2,5..9", in this order. Throws std::invalid_argument that says what is
/// wrong: no number, a range that goes down, a seed twice, more than a million.
std::vector<std::uint64_t> seeds_of(const std::string& text);

/// Values of one key of the file, "components.motion.ik.plugin=ik/numeric,ik/kdl".
struct Vary {
  std::string key;
  std::vector<std::string> values;
};
/// Throws std::invalid_argument, also of `seed` and `clock`, which a sweep sets itself. A comma in
/// brackets or braces belongs to its value.
Vary vary_of(const std::string& text);

/// Throws std::invalid_argument for an assignment (--set) of what a sweep sets itself: `seed`, and
/// a `clock` that is not the simulated one.
void check_assignment(const std::string& text);

/// The assignments of each combination of values, in order: the last key changes fastest. One empty
/// list of nothing to vary. Throws std::invalid_argument for a key that is there twice.
std::vector<std::vector<std::string>> combinations(const std::vector<Vary>& vary);

}  // namespace armature::sweep
