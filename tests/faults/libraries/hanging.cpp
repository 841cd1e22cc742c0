// SPDX-License-Identifier: Apache-2.0
// Takes for ever to load.
#include <unistd.h>

#include "armature/runtime/plugins/abi.hpp"

static const char manifest[] __attribute__((section(".armature.manifest"), used, retain)) =
    "armature_plugin: 1\nid: ik/hanging\nkind: ik\ndoc: Takes for ever to load.\n";

static const char abi[] __attribute__((section(".armature.abi"), used, retain)) = ARMATURE_ABI_TAG;

[[gnu::constructor]] static void hang() { sleep(1000); }
