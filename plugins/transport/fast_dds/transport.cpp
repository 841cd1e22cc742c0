// SPDX-License-Identifier: Apache-2.0
#include "armature/bus/fast_dds/fast_dds_transport.hpp"
#include "armature/runtime/plugins/plugin.hpp"

ARMATURE_PLUGIN(armature::FastDdsTransport);
