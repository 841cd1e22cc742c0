// SPDX-License-Identifier: Apache-2.0
#include "armature/bus/fast_dds/plain_exchange.hpp"
#include "armature/runtime/plugins/plugin.hpp"

ARMATURE_PLUGIN(armature::PlainExchange);
