// SPDX-License-Identifier: Apache-2.0
// Built for another framework, says its tag.

static const char manifest[] __attribute__((section(".armature.manifest"), used, retain)) =
    "armature_plugin: 1\nid: ik/old\nkind: ik\ndoc: Built long ago.\n";

static const char abi[] __attribute__((section(".armature.abi"), used, retain)) =
    "armature 0, compiler abi 1014";
