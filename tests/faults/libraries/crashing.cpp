// SPDX-License-Identifier: Apache-2.0
// Ends the process that loads it.
#include <cstdlib>

#include "armature/runtime/plugins/abi.hpp"

static const char manifest[] __attribute__((section(".armature.manifest"), used, retain)) =
    "armature_plugin: 1\nid: ik/crashing\nkind: ik\ndoc: Crashes when it is loaded.\n";

static const char abi[] __attribute__((section(".armature.abi"), used, retain)) = ARMATURE_ABI_TAG;

[[gnu::constructor]] static void crash() { std::abort(); }
