// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/plugin.hpp"

#include "armature/bus/fast_dds/observer.hpp"

ARMATURE_PLUGIN(armature::DdsObserver);
