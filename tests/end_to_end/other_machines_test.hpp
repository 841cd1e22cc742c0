// SPDX-License-Identifier: Apache-2.0
// For the tests with a second machine, at a cable that may have faults.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "deployment_run.hpp"
#include "tests/dds_domain.hpp"
#include "two_hosts.hpp"

namespace armature::test {

class OtherMachines : public testing::Test {
 protected:
  static constexpr std::chrono::seconds kTimeout{30};
  static inline const std::string kJoined = "dds.interfaces=[eth0]";

  explicit OtherMachines(const std::vector<std::string>& faults) : hosts_{faults} {}
  void SetUp() override {
    if (!hosts_.missing().empty()) GTEST_SKIP() << hosts_.missing();
  }

  /// `armature run FILE WORDS --set SETTING ..` on that host.
  std::unique_ptr<Command> start(const TwoHosts::Host& host, const std::string& file,
                                 std::vector<std::string> settings,
                                 const std::vector<std::string>& words = {}) const {
    const DeploymentStart start{
        .files = {source_file(file)}, .settings = std::move(settings), .domain = domain_};
    std::vector<std::string> all = deployment_command(start);
    all.insert(all.end(), words.begin(), words.end());
    return std::make_unique<Command>(
        host.command(all),
        Command::Options{.environment = {{"ARMATURE_PLUGIN_PATH", TEST_PLUGINS}}, .input = {}});
  }

  std::unique_ptr<Command> start_pulse(std::vector<std::string> settings) const {
    settings.push_back("components.ear.params.listens_s=1000");
    return start(robot_, "tests/end_to_end/pulse.yaml", std::move(settings));
  }

  /// `armature topic hz TOPIC WORDS` on that host, over eth0.
  std::vector<std::string> hz_on(const TwoHosts::Host& host, const std::string& topic,
                                 const std::vector<std::string>& words) const {
    std::vector<std::string> all{armature(),    "topic",    "hz",
                                 topic,         "--domain", std::to_string(domain_),
                                 "--interface", "eth0"};
    all.insert(all.end(), words.begin(), words.end());
    return host.command(all);
  }

  const int domain_ = unique_dds_domain();
  TwoHosts hosts_;
  const TwoHosts::Host& robot_ = hosts_.robot();
  const TwoHosts::Host& desk_ = hosts_.desk();
};

}  // namespace armature::test
