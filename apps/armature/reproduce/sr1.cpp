// SPDX-License-Identifier: Apache-2.0
// SR-1, a frameless stereotactic neurosurgery robot (thesis, Nanjing University of Science and
// Technology, 2005).
#include "reproduce/papers.hpp"
#include "reproduce/sr1_parts.hpp"

namespace armature::reproduce {

void compute_sr1(const Numbers& numbers, bool with_long, Results& results) {
  sr1::add_poses(numbers, results);
  if (with_long) sr1::add_round_trips(results);
  sr1::add_registrations(numbers, with_long, results);
  sr1::add_insertion(numbers, results);
  sr1::add_choice(numbers, results);
  sr1::add_splines(numbers, results);
}

}  // namespace armature::reproduce
