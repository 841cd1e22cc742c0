// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/kinds/ik/contract/probe.hpp"

namespace armature::ik_contract {

#define ARMATURE_IK_LAW_FUNCTION(Name, function, says) void function(Probe& probe);
ARMATURE_IK_LAWS(ARMATURE_IK_LAW_FUNCTION)
#undef ARMATURE_IK_LAW_FUNCTION

}  // namespace armature::ik_contract
