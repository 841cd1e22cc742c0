// SPDX-License-Identifier: Apache-2.0
// A transport/fast_dds that finds one megabyte left for shared memory. In a folder of its own,
// which a test puts before the framework's with ARMATURE_PLUGIN_PATH: the first of an id wins.
#include <filesystem>

#include "armature/bus/fast_dds/fast_dds_transport.hpp"
#include "armature/runtime/plugins/abi.hpp"
#include "armature/runtime/plugins/plugin.hpp"

static const char manifest[] __attribute__((section(".armature.manifest"), used, retain)) =
    "armature_plugin: 1\nid: transport/fast_dds\nkind: transport\ndoc: Finds no room.\n";

static const char abi[] __attribute__((section(".armature.abi"), used, retain)) = ARMATURE_ABI_TAG;

namespace armature {

class FullSharedMemoryTransport : public Transport {
 public:
  static Expected<std::unique_ptr<Transport>> make(const TransportOptions& options) {
    const auto one_mib = [](const auto&) { return Expected<std::uint64_t>{1U << 20}; };
    return FastDdsTransport::make(
        options, {.folder = std::filesystem::temp_directory_path(), .free_bytes = one_mib});
  }
};

}  // namespace armature

ARMATURE_PLUGIN(armature::FullSharedMemoryTransport);
