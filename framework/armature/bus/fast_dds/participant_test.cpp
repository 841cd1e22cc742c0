// SPDX-License-Identifier: Apache-2.0
// How a process joins: its domain, its shared memory, its library.
#include <dlfcn.h>
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "armature/bus/fast_dds/fast_dds_test.hpp"
#include "armature/bus/fast_dds/observer.hpp"
#include "armature/bus/fast_dds/spdp_announcement_test.hpp"
#include "armature/runtime/plugins/plugin.hpp"

namespace armature {
namespace {

TEST_F(FastDds, ADomainOutOfRangeIsRefused) {
  domain_ = 233;
  TransportOptions options;
  options.network.domain = 233;
  const auto made = FastDdsTransport::make(options);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().text, "DDS domain 233 is not within 0 and 232");
}

TEST_F(FastDds, AnInterfaceThatIsAbsentIsRefused) {
  TransportOptions options;
  options.network.domain = domain_;
  options.network.interfaces = {"lo", "elsewhere0"};
  const auto made = FastDdsTransport::make(options);
  ASSERT_FALSE(made);
  EXPECT_THAT(made.error().text,
              testing::StartsWith("there is no interface 'elsewhere0'; this machine has lo ("));
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

TEST_F(FastDds, AParticipantOfAnotherMachineIsIgnoredAndNamed) {
  const auto transport = make_transport();
  const auto elsewhere = spdp_announcement("stranger", {203, 0, 113, 7});
  ASSERT_TRUE(announce(domain_, elsewhere));
  EXPECT_EQ(event(Kind::note),
            "participant 'stranger' is ignored: it is not on this machine (it answers at "
            "203.0.113.7), and only the loopback interface is joined");
  ASSERT_TRUE(announce(domain_, elsewhere));
  const auto observer = DdsObserver::make({.network = {.domain = domain_}}).value();
  EXPECT_EQ(events(Kind::note), 1);
}

TEST_F(FastDds, AParticipantOfThisMachineIsNot) {
  const auto transport = make_transport();
  ASSERT_TRUE(announce(domain_, spdp_announcement("neighbour", {127, 0, 0, 1})));
  ASSERT_TRUE(announce(domain_, spdp_announcement("stranger", {203, 0, 113, 7}, 8)));
  EXPECT_EQ(event(Kind::note).substr(0, 22), "participant 'stranger'");
  EXPECT_EQ(events(Kind::note), 1);
}

/// A container: its processes share the network of this machine, and not its /dev/shm.
const std::vector<std::string> kContainer{"/usr/bin/unshare",
                                          "--user",
                                          "--map-root-user",
                                          "--mount",
                                          "/bin/sh",
                                          "-c",
                                          "mount -t tmpfs tmpfs /dev/shm && exec \"$0\" \"$@\""};

bool has_containers() {
  return std::system("/usr/bin/unshare --user --map-root-user --mount true 2>/dev/null") == 0;
}

TEST_F(FastDds, WhoeverCannotBeReachedThroughSharedMemoryIsNamed) {
  if (!has_containers()) GTEST_SKIP() << "no user namespace may be made here";
  const auto transport = make_transport();
  Peer peer{domain_, "lamp", "f00d", "echo", kContainer};
  EXPECT_THAT(
      event(Kind::note),
      testing::ContainsRegex(
          "participant 'armature lamp' \\(pid [0-9]+ on [^)]+\\) is on this machine and gets "
          "nothing from here through shared memory \\([^)]*/dev/shm/fastrtps_port[0-9]+[^)]*\\): "
          "it is "
          "in another container, or another user's. Let one of the two use none: `dds: "
          "\\{shared_memory: off\\}`, or --no-shared-memory"));
}

TEST_F(FastDds, WithoutSharedMemoryContainersHearEachOther) {
  if (!has_containers()) GTEST_SKIP() << "no user namespace may be made here";
  TransportOptions options;
  options.network = {.domain = domain_, .shared_memory = false};
  options.deployment = "lamp";
  options.fingerprint = "f00d";
  const auto transport = FastDdsTransport::make(options).value();
  Peer peer{domain_, "lamp", "f00d", "echo", kContainer};
  const auto writer = transport->advertise(to_peer_).value();
  const auto reader = transport->subscribe(from_peer_, false, collect()).value();
  EXPECT_TRUE(eventually([&] {
    writer->offer(sample(1));
    return received() > 0;
  }));
}

TEST_F(FastDds, SharedMemoryIsItsUsersOnly) {
  const auto transport = make_transport();
  const auto writer = transport->advertise(to_peer_).value();
  std::ifstream maps{"/proc/self/maps"};
  int files = 0;
  for (std::string line; std::getline(maps, line);) {
    const auto path = line.find("/dev/shm/");
    if (path == std::string::npos || line.ends_with("(deleted)")) continue;
    ++files;
    const auto others = std::filesystem::perms::group_all | std::filesystem::perms::others_all;
    EXPECT_EQ(std::filesystem::status(line.substr(path)).permissions() & others,
              std::filesystem::perms::none)
        << line;
  }
  EXPECT_GT(files, 0);
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
      options.network.domain = domain_;
      const auto made = reinterpret_cast<Transport::Factory>(entry->factory)(options);
      ASSERT_TRUE(made) << made.error().text;
      EXPECT_TRUE((*made)->advertise(to_peer_));
    }
    dlclose(library);
  }
}

}  // namespace
}  // namespace armature
