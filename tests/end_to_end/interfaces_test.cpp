// SPDX-License-Identifier: Apache-2.0
// A deployment and another machine: they hear each other only on interfaces that the file names,
// and there, too, the deployment's inputs take nothing from strangers.
#include <gmock/gmock.h>

#include <csignal>
#include <thread>

#include "deployment_run.hpp"
#include "tests/dds_domain.hpp"
#include "two_hosts.hpp"

namespace armature::test {
namespace {

using std::chrono::seconds;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

constexpr seconds kTimeout{30};
const std::string kJoined = "dds.interfaces=[eth0]";

class Interfaces : public testing::Test {
 protected:
  void SetUp() override {
    if (!hosts_.missing().empty()) GTEST_SKIP() << hosts_.missing();
  }

  /// The pulse on that host, until it is interrupted.
  std::unique_ptr<Command> start_pulse(const TwoHosts::Host& host,
                                       std::vector<std::string> settings) const {
    settings.push_back("components.ear.params.listens_s=1000");
    const DeploymentStart start{.files = {source_file("tests/end_to_end/pulse.yaml")},
                                .settings = std::move(settings),
                                .domain = domain_};
    return std::make_unique<Command>(
        host.command(deployment_command(start)),
        Command::Options{.environment = {{"ARMATURE_PLUGIN_PATH", TEST_PLUGINS}}, .input = {}});
  }

  /// `armature WORDS` on that host, in the domain of this test.
  std::vector<std::string> armature_on(const TwoHosts::Host& host,
                                       std::vector<std::string> words) const {
    words.insert(words.begin(), armature());
    words.insert(words.end(), {"--domain", std::to_string(domain_)});
    return host.command(words);
  }

  static CommandResult interrupt(Command& run) {
    run.signal(SIGINT);
    return run.finish(kTimeout);
  }

  const int domain_ = unique_dds_domain();
  const TwoHosts hosts_;
  const TwoHosts::Host& robot_ = hosts_.robot();
  const TwoHosts::Host& desk_ = hosts_.desk();
};

TEST_F(Interfaces, ThatADeploymentJoinsCarryItsTopicsToAnotherMachine) {
  const auto pulse = start_pulse(robot_, {kJoined});
  const std::vector<std::string> hz{"topic", "hz", "/pulse/beat", "-n", "20", "--timeout", "8"};
  auto by_name = hz, by_address = hz;
  by_name.insert(by_name.end(), {"--interface", "eth0"});
  by_address.insert(by_address.end(), {"--interface", desk_.address});
  Command there{armature_on(desk_, by_name)}, beside{armature_on(desk_, by_address)},
      here{armature_on(robot_, by_name)};
  for (Command* watch : {&there, &beside, &here}) {
    const auto result = watch->finish(kTimeout);
    EXPECT_EQ(result.exit_code, 0) << result.err << pulse->err();
    EXPECT_THAT(result.out, HasSubstr(" Hz over 20 samples in all"));
  }
  const auto run = interrupt(*pulse);
  EXPECT_THAT(run.err, HasSubstr("DDS joins lo, eth0 (10.77.0.1). Programs there may read every "
                                 "topic, and only DDS Security helps against one that copies the "
                                 "fingerprint\n"));
}

TEST_F(Interfaces, ThatADeploymentDoesNotJoinLeaveItAlone) {
  const auto pulse = start_pulse(robot_, {});
  // It brings the group's multicast to all of its machine.
  Command member{armature_on(robot_, {"topic", "hz", "/pulse/beat", "--interface", "eth0"})};
  ASSERT_TRUE(member.wait_for_out(" Hz over ", kTimeout)) << pulse->err();
  const auto watch = run_command(
      armature_on(desk_, {"topic", "hz", "/pulse/beat", "--timeout", "2", "--interface", "eth0"}));
  EXPECT_THAT(watch.err, HasSubstr("nobody writes '/pulse/beat'")) << watch.out;
  const auto run = interrupt(*pulse);
  EXPECT_THAT(run.err, ContainsRegex("participant 'armature observer' \\(pid [0-9]+ on [^)]+\\) is "
                                     "ignored: it is not on this machine \\(it answers at "
                                     "10.77.0.2\\), and only the loopback interface is joined"));
  EXPECT_THAT(run.err, Not(HasSubstr("DDS joins")));
}

TEST_F(Interfaces, ThatADeploymentJoinsLetItHearOnlyWhomTheyLeadTo) {
  // The way to 10.78.0.2, which is at the cable of eth0, leads into another one.
  const auto crossed = run_command(robot_.command(
      {"/bin/sh", "-c",
       "cd /proc/sys/net/ipv4/conf && echo 0 > all/rp_filter && echo 0 > eth0/rp_filter &&"
       "/bin/ip link add dev eth1 type veth peer name end1 && /bin/ip link set dev end1 up &&"
       "/bin/ip address add 10.78.0.1/24 dev eth1 && /bin/ip link set dev eth1 up"}));
  if (crossed.exit_code != 0) GTEST_SKIP() << "no second cable: " << crossed.err;
  run_command(desk_.command({"/bin/ip", "address", "add", "10.78.0.2/24", "dev", "eth0"}));
  const auto pulse = start_pulse(robot_, {kJoined});
  Command stranger{armature_on(
      desk_, {"topic", "hz", "/pulse/beat", "--timeout", "8", "--interface", "10.78.0.2"})};
  EXPECT_TRUE(pulse->wait_for_err(
      "it is not on this machine (it answers at 10.78.0.2), and no joined interface leads there: "
      "eth0 (10.77.0.1)\n",
      seconds{8}))
      << pulse->err();
}

TEST_F(Interfaces, ThatLoseTheirAddressLeaveTheProcessesOfAMachineTogether) {
  // Isolated: it has no shared memory to reach the other process by.
  const auto pulse = start_pulse(robot_, {kJoined, "components.beat.on_fault=isolate"});
  const std::vector<std::string> hz{"topic", "hz", "/pulse/beat", "-n", "20", "--timeout", "8"};
  auto joined = hz;
  joined.insert(joined.end(), {"--interface", "eth0"});
  EXPECT_EQ(run_command(armature_on(robot_, joined)).exit_code, 0) << pulse->err();
  run_command(robot_.command({"/bin/ip", "address", "flush", "dev", "eth0"}));
  std::this_thread::sleep_for(seconds{2});  // longer than the lease of a participant
  const auto run = interrupt(*pulse);
  EXPECT_THAT(run.err, Not(ContainsRegex("process '(main|aside)'[^\n]* fell silent")));
}

TEST_F(Interfaces, CarryNothingIntoAnInputThatTheDeploymentFeedsItself) {
  // Even one of the same deployment, on a machine that runs the same file.
  const auto pulse = start_pulse(robot_, {kJoined}), stranger = start_pulse(desk_, {kJoined});
  const std::string refused = "was refused on '/pulse/beat'";
  EXPECT_TRUE(pulse->wait_for_err(refused, seconds{8})) << pulse->err();
  std::this_thread::sleep_for(seconds{1});  // a hundred beats of the stranger
  const auto run = interrupt(*pulse);
  const std::string who = "deployment 'pulse', process 'aside' \\(pid [0-9]+ on [^)]+\\)";
  EXPECT_THAT(run.err, ContainsRegex("a writer of " + who +
                                     " \\(another run of this configuration\\) " + refused));
  EXPECT_THAT(run.err,
              ContainsRegex("[0-9]+ samples of " + who + " on '/pulse/beat' were refused"));
}

TEST_F(Interfaces, CarryAStopToAnotherMachine) {
  Command run{robot_.command(deployment_command({.files = {source_file("configs/sr1_biopsy.yaml")},
                                                 .settings = {kJoined, "clock=system"},
                                                 .domain = domain_}))};
  ASSERT_TRUE(run.wait_for_err("task      approach", kTimeout)) << run.err();
  const auto stop =
      run_command(armature_on(desk_, {"stop", "--timeout", "8", "--interface", "eth0"}));
  EXPECT_EQ(stop.exit_code, 0) << stop.err;
  EXPECT_THAT(stop.out, HasSubstr("stopped: deployment 'sr1_biopsy', process 'main' (pid "));
  EXPECT_TRUE(run.wait_for_err("a stop was asked for on the topic /stop", kTimeout)) << run.err();
}

}  // namespace
}  // namespace armature::test
