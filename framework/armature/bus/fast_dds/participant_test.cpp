// SPDX-License-Identifier: Apache-2.0
// How a process joins: its domain, its shared memory, its library.
#include <dlfcn.h>
#include <gmock/gmock.h>

#include "armature/bus/fast_dds/fast_dds_test.hpp"
#include "armature/runtime/plugin.hpp"

namespace armature {
namespace {

TEST_F(FastDds, ADomainOutOfRangeIsRefused) {
  domain_ = 233;
  TransportOptions options;
  options.domain = 233;
  const auto made = FastDdsTransport::make(options);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().text, "DDS domain 233 is not within 0 and 232");
}

TEST_F(FastDds, WithoutSharedMemoryTopicsGoOverUdp) {
  Peer peer{domain_, "lamp", "f00d", "echo"};
  const auto transport = make_transport({.folder = "/proc"});
  EXPECT_THAT(event(Kind::note),
              testing::StartsWith("no shared memory, topics go over UDP: /proc is not writable"));
  const auto writer = transport->advertise(to_peer_).value();
  const auto reader = transport->subscribe(from_peer_, false, collect()).value();
  ASSERT_TRUE(eventually([&] {
    writer->offer(sample(1));
    return received() > 0;
  }));
}

TEST_F(FastDds, SharedMemoryThatIsNearlyFullIsNotUsedAndSaidSo) {
  const auto one_mib = [](const auto&) { return Expected<std::uint64_t>{1U << 20}; };
  const auto folder = std::filesystem::temp_directory_path();
  const auto transport = make_transport({.folder = folder, .free_bytes = one_mib});
  EXPECT_EQ(event(Kind::note), "no shared memory, topics go over UDP: " + folder.string() +
                                   " has 1 MiB free, 18 MiB are needed");
}

TEST_F(FastDds, ThePluginLibraryUnloadsAfterUse) {
  for (int round = 0; round < 3; ++round) {
    void* library = dlopen(ARMATURE_PLUGIN_BUILD_DIR "/transport_fast_dds.so", RTLD_NOW);
    ASSERT_NE(library, nullptr) << dlerror();
    const auto* entry = static_cast<const PluginEntry*>(dlsym(library, "armature_plugin_entry"));
    ASSERT_NE(entry, nullptr);
    EXPECT_EQ(std::string{entry->kind}, "transport");
    {
      TransportOptions options;
      options.domain = domain_;
      const auto made = reinterpret_cast<Transport::Factory>(entry->factory)(options);
      ASSERT_TRUE(made) << made.error().text;
      EXPECT_TRUE((*made)->advertise(to_peer_));
    }
    dlclose(library);
  }
}

}  // namespace
}  // namespace armature
