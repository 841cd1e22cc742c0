// SPDX-License-Identifier: Apache-2.0
#include "objective.hpp"

namespace armature {

Objective objective_from(std::string_view name) {
  if (name == "limits") return Objective::limits;
  if (name == "singularity") return Objective::singularity;
  if (name == "continuity") return Objective::continuity;
  return Objective::balanced;
}

}  // namespace armature
