// SPDX-License-Identifier: Apache-2.0
// Machines that a cable with faults joins: one that carries no multicast, as many networks do not,
// and one that loses and doubles what it carries.
#include "other_machines_test.hpp"

#include <gmock/gmock.h>

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

namespace armature::test {
namespace {

using std::chrono::seconds;
using testing::HasSubstr;

class WithoutMulticast : public OtherMachines {
 protected:
  WithoutMulticast() : OtherMachines{{"--no-multicast"}} {}
};

TEST_F(WithoutMulticast, NobodyIsFoundUnlessItIsNamed) {
  const auto pulse = start_pulse({kJoined});
  const auto unnamed = run_command(hz_on(desk_, "/pulse/beat", {"--timeout", "3"}));
  EXPECT_THAT(unnamed.err, HasSubstr("nobody writes '/pulse/beat'")) << unnamed.out;
  const auto named = run_command(
      hz_on(desk_, "/pulse/beat", {"-n", "20", "--timeout", "8", "--peer", robot_.address}));
  EXPECT_EQ(named.exit_code, 0) << named.err << pulse->err();
}

TEST_F(WithoutMulticast, APeerIsFoundWhateverElseItsMachineRuns) {
  // Each takes a port of the machine, and Fast DDS asks four when it is not told.
  std::vector<std::unique_ptr<Command>> others;
  for (int i = 0; i < 6; ++i) {
    others.push_back(std::make_unique<Command>(hz_on(robot_, "/pulse/beat", {})));
  }
  for (const auto& other : others) {
    ASSERT_TRUE(other->wait_for_err("waiting for it", kTimeout)) << other->err();
  }
  const auto pulse = start_pulse({kJoined});
  const auto named = run_command(
      hz_on(desk_, "/pulse/beat", {"-n", "20", "--timeout", "8", "--peer", robot_.address}));
  EXPECT_EQ(named.exit_code, 0) << named.err << pulse->err();
}

TEST_F(WithoutMulticast, ADeploymentFindsAPeerThatAsksNobody) {
  const auto watch =
      std::make_unique<Command>(hz_on(desk_, "/pulse/beat", {"-n", "20", "--timeout", "15"}));
  const auto pulse = start_pulse({kJoined, "dds.peers=[" + desk_.address + "]"});
  EXPECT_EQ(watch->finish(kTimeout).exit_code, 0) << pulse->err();
  EXPECT_THAT(pulse->err(), HasSubstr("and looks for others also at " + desk_.address));
}

TEST_F(WithoutMulticast, ADiscoveryServerLeadsToEverybody) {
  const std::string server = "/usr/bin/fast-discovery-server";
  if (!std::filesystem::exists(server)) GTEST_SKIP() << "no " << server << " (fastdds-tools)";
  const Command serves{robot_.command({server, "-i", "0", "-l", robot_.address, "-p", "11811"})};
  const auto pulse = start_pulse({kJoined, "dds.discovery_server=" + robot_.address});
  const auto watch = run_command(
      hz_on(desk_, "/pulse/beat",
            {"-n", "20", "--timeout", "8", "--discovery-server", robot_.address + ":11811"}));
  EXPECT_EQ(watch.exit_code, 0) << watch.err << pulse->err() << serves.err() << serves.out();
}

TEST_F(WithoutMulticast, ADiscoveryServerThatDoesNotAnswerEndsTheStart) {
  const auto pulse = start_pulse({kJoined, "dds.discovery_server=" + desk_.address});
  const auto ended = pulse->finish(kTimeout);
  EXPECT_NE(ended.exit_code, 0);
  EXPECT_THAT(ended.err, HasSubstr("no discovery server answers at 10.77.0.2:11811; start it "
                                   "there: fastdds discovery -i 0 -l 10.77.0.2 -p 11811"));
}

class OverALossyCable : public OtherMachines {
 protected:
  OverALossyCable()
      : OtherMachines{
            {"--seed", "7", "--lost", "0.2", "--doubled", "0.1", "--count", "counted_joint"}} {}
};

TEST_F(OverALossyCable, AMonitorGetsEveryPacketThatCameThroughOnce) {
  const auto arm = start(
      robot_, "tests/end_to_end/arm_watched.yaml",
      {kJoined, "clock=system", "robots.arm=" + source_file("tests/end_to_end/counted_arm.yaml")});
  Command watch{hz_on(desk_, "/watched/arm/measured_js", {"--best-effort", "--json"})};
  ASSERT_TRUE(watch.wait_for_out("\"second\"", kTimeout)) << watch.err() << arm->err();
  std::this_thread::sleep_for(seconds{2});
  arm->signal(SIGINT);
  arm->finish(kTimeout);
  watch.signal(SIGINT);
  const std::string out = watch.finish(kTimeout).out;
  const auto all = nlohmann::json::parse(out.substr(out.rfind("{\"over\"")));
  EXPECT_GT(all.at("samples").get<int>(), 100) << out;
  EXPECT_EQ(all.at("samples").get<int>(), hosts_.counted()) << out;
}

}  // namespace
}  // namespace armature::test
