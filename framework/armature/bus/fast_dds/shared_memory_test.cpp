// SPDX-License-Identifier: Apache-2.0
#include "armature/bus/fast_dds/shared_memory.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "armature/values/temporary_folder.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;

class SharedMemoryTest : public testing::Test {
 protected:
  void touch(const std::string& name) { std::ofstream{folder_ / name} << "x"; }
  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator{folder_.path()})
      names.insert(entry.path().filename());
    return names;
  }
  /// "fast_datasharing_" of a process.
  static std::string data_sharing_of(pid_t pid) {
    char text[100];
    std::snprintf(text, sizeof text,
                  "fast_datasharing_01.0f.78.fd.%02x.%02x.fc.84.01.00.00.00_0.0.1.3",
                  static_cast<unsigned>(pid) & 0xff, static_cast<unsigned>(pid) >> 8 & 0xff);
    return text;
  }
  const TemporaryFolder folder_;
};

/// `folder` on a file system that has so much room left.
SharedMemory with_room(const fs::path& folder, std::uint64_t bytes) {
  return {.folder = folder,
          .free_bytes = [bytes](const fs::path&) { return Expected<std::uint64_t>{bytes}; }};
}

TEST_F(SharedMemoryTest, IsUsableWhenThereIsRoom) {
  EXPECT_TRUE(check_shared_memory(with_room(folder_.path(), 18U << 20), 18U << 20));
}

TEST_F(SharedMemoryTest, TooLittleIsToldWithBothSizes) {
  const auto usable = check_shared_memory(with_room(folder_.path(), (18U << 20) - 1), 18U << 20);
  ASSERT_FALSE(usable);
  EXPECT_EQ(usable.error().text, folder_.path().string() + " has 17 MiB free, 18 MiB are needed");
}

TEST_F(SharedMemoryTest, TheRoomOfARealFolderIsMeasured) {
  EXPECT_GT(free_bytes_of(folder_.path()).value(), 0U);
  EXPECT_EQ(free_bytes_of("/proc").value(), 0U);
  EXPECT_EQ(free_bytes_of("/none").error().text, "/none: No such file or directory");
}

TEST_F(SharedMemoryTest, AFolderThatIsNotThereIsTold) {
  const auto usable = check_shared_memory({.folder = folder_ / "none"}, 1);
  ASSERT_FALSE(usable);
  EXPECT_EQ(usable.error().text,
            (folder_ / "none").string() + " is not writable: No such file or directory");
}

TEST_F(SharedMemoryTest, LeavesNoProbeBehind) {
  EXPECT_TRUE(check_shared_memory(with_room(folder_.path(), 1), 1));
  EXPECT_TRUE(files().empty());
}

TEST_F(SharedMemoryTest, WhatNobodyLocksIsRemoved) {
  for (const char* name : {"fastrtps_00aa", "fastrtps_00aa_el", "fastrtps_port7410",
                           "fastrtps_port7410_el", "sem.fastrtps_port7410_mutex"}) {
    touch(name);
  }
  EXPECT_EQ(clean_shared_memory(folder_.path()), 5);
  EXPECT_TRUE(files().empty());
}

TEST_F(SharedMemoryTest, WhatIsLeftOverIsNamedAndStaysUntilItIsRemoved) {
  for (const char* name : {"fastrtps_00aa", "fastrtps_00aa_el", "fastrtps_00cc", "fastrtps_00cc_el",
                           "other_program"}) {
    touch(name);
  }
  const int lock = open((folder_ / "fastrtps_00cc_el").c_str(), O_RDWR | O_CLOEXEC);
  EXPECT_EQ(left_in_shared_memory(folder_.path()),
            (std::vector<fs::path>{folder_ / "fastrtps_00aa", folder_ / "fastrtps_00aa_el"}));
  EXPECT_EQ(files().size(), 5U);
  close(lock);
  EXPECT_EQ(clean_shared_memory(folder_.path()), 4);
  EXPECT_TRUE(left_in_shared_memory(folder_.path()).empty());
}

TEST_F(SharedMemoryTest, WhatSomebodyLocksStays) {
  const std::set<std::string> names{"fastrtps_00aa", "fastrtps_00aa_el", "fastrtps_port7400",
                                    "fastrtps_port7400_el", "fastrtps_port7400_sl"};
  for (const std::string& name : names) touch(name);
  std::vector<int> locks;
  for (const char* name : {"fastrtps_00aa_el", "fastrtps_port7400_sl"}) {
    locks.push_back(open((folder_ / name).c_str(), O_RDWR | O_CLOEXEC));
    ASSERT_EQ(flock(locks.back(), LOCK_SH), 0);
  }
  EXPECT_EQ(clean_shared_memory(folder_.path()), 0);
  EXPECT_EQ(files(), names);
  for (const int lock : locks) close(lock);
}

TEST_F(SharedMemoryTest, APortReachesWhoeverElseListensThere) {
  const auto checked = [&] { return check_shared_memory_port(folder_.path(), 7411); };
  const std::string file = (folder_ / "fastrtps_port7411").string();
  EXPECT_EQ(checked().error().text, file + ": No such file or directory");
  touch("fastrtps_port7411");
  EXPECT_EQ(checked().error().text, "nobody listens at " + file);
  touch("fastrtps_port7411_el");
  EXPECT_EQ(checked().error().text, "nobody listens at " + file);
  const int lock = open((file + "_el").c_str(), O_RDWR | O_CLOEXEC);
  EXPECT_EQ(checked().error().text, "nobody listens at " + file) << "whoever sends opens it, too";
  ASSERT_EQ(flock(lock, LOCK_EX), 0);
  EXPECT_EQ(checked().error().text, file + " is its own");
  close(lock);
  const pid_t listener = fork();
  if (listener == 0) {
    const int held = open((file + "_el").c_str(), O_RDWR | O_CLOEXEC);
    _exit(flock(held, LOCK_EX) == 0 && pause() ? 0 : 1);
  }
  for (int i = 0; i < 1000 && !checked(); ++i) usleep(1000);
  EXPECT_TRUE(checked());
  kill(listener, SIGKILL);
  waitpid(listener, nullptr, 0);
}

TEST_F(SharedMemoryTest, WhatIsMappedStays) {
  touch("fastrtps_port7412");
  const int file = open((folder_ / "fastrtps_port7412").c_str(), O_RDWR | O_CLOEXEC);
  void* mapped = mmap(nullptr, 1, PROT_READ, MAP_SHARED, file, 0);
  ASSERT_NE(mapped, MAP_FAILED);
  EXPECT_EQ(clean_shared_memory(folder_.path()), 0);
  munmap(mapped, 1);
  close(file);
  EXPECT_EQ(clean_shared_memory(folder_.path()), 1);
}

TEST_F(SharedMemoryTest, WhatSomebodyIsAboutToLockOrMapStays) {
  touch("fastrtps_00cc");
  touch("fastrtps_00cc_el");
  const int lock = open((folder_ / "fastrtps_00cc_el").c_str(), O_RDWR | O_CLOEXEC);
  EXPECT_EQ(clean_shared_memory(folder_.path()), 0);
  close(lock);
  EXPECT_EQ(clean_shared_memory(folder_.path()), 2);
}

TEST_F(SharedMemoryTest, WhatIsOfOtherProgramsStays) {
  touch("other_program");
  touch("sem.other");
  EXPECT_EQ(clean_shared_memory(folder_.path()), 0);
  EXPECT_EQ(files().size(), 2U);
}

TEST_F(SharedMemoryTest, DataSharingGoesWithItsProcess) {
  const pid_t ended = fork();
  if (ended == 0) _exit(0);
  // Not yet collected: its number is still taken.
  touch(data_sharing_of(ended));
  touch(data_sharing_of(getpid()));
  touch("fast_datasharing_nonsense");
  EXPECT_EQ(clean_shared_memory(folder_.path()), 0);
  waitpid(ended, nullptr, 0);
  EXPECT_EQ(clean_shared_memory(folder_.path()), 1);
  EXPECT_EQ(files(),
            (std::set<std::string>{data_sharing_of(getpid()), "fast_datasharing_nonsense"}));
}

}  // namespace
}  // namespace armature
