// SPDX-License-Identifier: Apache-2.0
#include "doctor/judge.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <stdexcept>

#include "armature/bus/fast_dds/receive_buffer.hpp"
#include "armature/bus/fast_dds/shared_memory.hpp"

namespace armature::doctor {
namespace {

using testing::Each;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;

/// A machine that lacks nothing.
Facts good() {
  return {.shared_memory = {.free_bytes = 1U << 30},
          .rights = {.rtprio = 95, .nofile = 1024},
          .kernel = {.release = "6.1.0-rt",
                     .real_time = true,
                     .processors = 2,
                     .governors = {"performance"}},
          .network = {.interfaces = {{"lo", {"127.0.0.1"}, true, true},
                                     {"eth0", {"10.0.0.5"}, true, true}},
                      .max_receive_buffer = kReceiveBuffer},
          .clock = {.resolution_ns = 1, .synchronised = true},
          .plugins = {.folders = {"/opt/plugins"}, .usable = 3},
          .versions = {{"armature", "1.2.3"}}};
}

/// The first finding about `what`.
Finding about(const std::string& what, const Facts& facts) {
  const auto findings = judge(facts);
  const auto found = std::ranges::find(findings, what, &Finding::what);
  if (found == findings.end()) throw std::runtime_error("nothing is said about " + what);
  return *found;
}

std::vector<std::string> not_ok(const Facts& facts) {
  std::vector<std::string> all;
  for (const Finding& finding : judge(facts)) {
    if (finding.level != Level::ok) all.push_back(finding.what);
  }
  return all;
}

TEST(Doctor, FindsNothingWrongWithAGoodMachine) {
  EXPECT_THAT(not_ok(good()), IsEmpty());
  EXPECT_THAT(judge(good()), Each(Field(&Finding::hint, "")));
  EXPECT_THAT(judge(good()), Each(Field(&Finding::meaning, testing::Not(IsEmpty()))));
  EXPECT_EQ(about("version", good()).value, "armature 1.2.3");
  EXPECT_EQ(about("other interfaces", good()).value, "eth0 (10.0.0.5)");
}

TEST(Doctor, WarnsWhereTheSystemKeepsLessThanPicturesNeed) {
  Facts facts = good();
  facts.network.max_receive_buffer = 212'992;
  EXPECT_EQ(about("receive buffer", facts).level, Level::warning);
  EXPECT_EQ(about("receive buffer", facts).value, "at most 212992 bytes (net.core.rmem_max)");
  EXPECT_THAT(about("receive buffer", facts).hint,
              HasSubstr("echo net.core.rmem_max=4194304 | sudo tee /etc/sysctl.d/"));
}

TEST(Doctor, SaysAWayOutOfEverythingThatIsNotOk) {
  const Facts bad{.shared_memory = {.free_bytes = 1, .left_over = {"/dev/shm/a"}},
                  .rights = {.nofile = 8, .priority_refused = "no", .memory_refused = "no"},
                  .kernel = {.processors = 1, .governors = {"powersave"}},
                  .network = {.multicast_lost = "lost", .max_receive_buffer = 212'992},
                  .clock = {.resolution_ns = 4000000},
                  .plugins = {.warnings = {"no folder"}, .unusable = {{"/x.so", "broken"}}}};
  EXPECT_EQ(not_ok(bad).size(), 16U);
  for (const Finding& finding : judge(bad)) {
    EXPECT_EQ(finding.level == Level::ok, finding.hint.empty()) << finding.what;
  }
}

TEST(Doctor, WarnsOfSharedMemoryThatCannotBeWrittenAndAsksNoMoreOfIt) {
  Facts facts = good();
  facts.shared_memory = {.folder = "/none", .unusable = "/none is not writable"};
  EXPECT_THAT(not_ok(facts), testing::ElementsAre("shared memory"));
  EXPECT_THAT(about("shared memory", facts).hint, HasSubstr("/none"));
}

TEST(Doctor, WantsRoomForOneProcessInSharedMemory) {
  Facts facts = good();
  facts.shared_memory.free_bytes = kSharedMemoryOfProcess;
  EXPECT_THAT(not_ok(facts), IsEmpty());
  facts.shared_memory.free_bytes = kSharedMemoryOfProcess - 1;
  EXPECT_EQ(about("free shared memory", facts).level, Level::warning);
  EXPECT_EQ(about("free shared memory", facts).value, "17 MiB");
}

TEST(Doctor, CountsWhatDeadProcessesLeft) {
  Facts facts = good();
  facts.shared_memory.left_over = {"/dev/shm/a", "/dev/shm/b"};
  EXPECT_EQ(about("left-over segments", facts).level, Level::warning);
  EXPECT_EQ(about("left-over segments", facts).value, "2 (/dev/shm/a, ...)");
}

TEST(Doctor, TellsTheLimitBesideARefusedRight) {
  Facts facts = good();
  facts.rights = {.memlock_bytes = 8U << 20,
                  .rtprio = 0,
                  .nofile = 1023,
                  .priority_refused = "Operation not permitted",
                  .memory_refused = "the limit is 8192 KiB"};
  EXPECT_EQ(about("real-time priority", facts).value,
            "SCHED_FIFO 80 refused: Operation not permitted (rtprio 0)");
  EXPECT_EQ(about("locked memory", facts).value,
            "refused (memlock 8192 KiB): the limit is 8192 KiB");
  EXPECT_THAT(not_ok(facts),
              testing::ElementsAre("real-time priority", "locked memory", "open files"));
}

TEST(Doctor, WarnsOfAProcessorWhoseSpeedFollowsItsLoad) {
  Facts facts = good();
  facts.kernel.governors = {"performance", "schedutil"};
  EXPECT_EQ(about("cpu frequency", facts).level, Level::warning);
  EXPECT_EQ(about("cpu frequency", facts).value, "governor performance, schedutil");
  facts.kernel.governors = {};
  EXPECT_EQ(about("cpu frequency", facts).level, Level::ok);
}

TEST(Doctor, HasAProblemWithALoopbackThatIsDown) {
  Facts facts = good();
  facts.network.interfaces[0].up = false;
  EXPECT_EQ(about("loopback", facts).level, Level::problem);
  EXPECT_EQ(about("loopback", facts).value, "lo is down");
  facts.network.interfaces.clear();
  EXPECT_EQ(about("loopback", facts).level, Level::problem);
}

TEST(Doctor, HasAProblemWithMulticastThatDoesNotComeBack) {
  Facts facts = good();
  facts.network.multicast_lost = "did not come back";
  EXPECT_EQ(about("multicast on loopback", facts).level, Level::problem);
}

TEST(Doctor, JoinsNoInterfaceThatIsDownOrHasNoAddress) {
  Facts facts = good();
  facts.network.interfaces = {{"lo", {"127.0.0.1"}, true, true},
                              {"eth0", {"10.0.0.5"}, false, true},
                              {"eth1", {"10.0.0.6"}, true, false},
                              {"eth2", {}, true, true}};
  EXPECT_EQ(about("other interfaces", facts).value, "none");
}

TEST(Doctor, NamesEveryLibraryThatDoesNotLoadWithItsReason) {
  Facts facts = good();
  facts.plugins.unusable = {{"/my a.so", "no manifest"}, {"/b.so", "built for another"}};
  EXPECT_THAT(not_ok(facts), testing::ElementsAre("plugin library", "plugin library"));
  EXPECT_EQ(about("plugin library", facts).value, "/my a.so: no manifest");
  EXPECT_THAT(about("plugin library", facts).hint, HasSubstr("ldd -r '/my a.so'  #"));
  EXPECT_EQ(about("plugin library", facts).level, Level::problem);
}

TEST(Doctor, HasAProblemWhenNoPluginLoads) {
  Facts facts = good();
  facts.plugins.usable = 0;
  EXPECT_EQ(about("plugins", facts).level, Level::problem);
}

}  // namespace
}  // namespace armature::doctor
