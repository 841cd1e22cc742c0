// SPDX-License-Identifier: Apache-2.0
// Processes that nobody starts together begin together, however late one of them meets another.
#include "armature/runtime/deployment/common_start.hpp"

#include <gmock/gmock.h>

#include <functional>
#include <map>

#include "armature/messages/std_msgs.hpp"

namespace armature {
namespace {

using testing::Optional;
using testing::StrEq;

/// Topics in memory that meet when the test says so, each process by itself.
struct LateNetwork {
  std::set<std::string> has_met;    // processes to which others are known
  std::set<std::string> has_heard;  // processes that get what is sent
  std::map<std::string, std::function<void(SampleRef)>> readers;  // by process
  std::set<std::string> sent;  // topics, each with a sample that is kept for who comes late
  std::set<std::string> gone;  // processes, with what they sent

  void deliver() {
    for (const std::string& process : gone)
      std::erase_if(sent, [&](const std::string& topic) { return topic.ends_with("/" + process); });
    for (const std::string& topic : sent) {
      for (const auto& [process, reader] : readers) {
        if (has_heard.contains(process) && !topic.ends_with("/" + process)) reader({});
      }
    }
  }
};

class LateWriter final : public RemoteWriter {
 public:
  LateWriter(LateNetwork& network, std::string process, std::string topic)
      : network_{network}, process_{std::move(process)}, topic_{std::move(topic)} {}
  void offer(const SampleRef&) override { network_.sent.insert(topic_); }
  int matched_readers() const override { return peers(); }
  int peers() const override {
    return network_.has_met.contains(process_) && network_.gone.empty() ? 1 : 0;
  }
  std::uint64_t dropped() const override { return 0; }
  std::vector<Watcher> who_watches() const override { return {}; }
  bool acknowledged(Duration) override {
    return network_.has_heard.contains(process_ == "main" ? "aside" : "main");
  }

 private:
  LateNetwork& network_;
  std::string process_, topic_;
};

class LateReader final : public RemoteReader {
 public:
  LateReader(const LateNetwork& network, std::string topic)
      : network_{network}, topic_{std::move(topic)} {}
  int writers() const override { return peers(); }
  int peers() const override { return network_.sent.contains(topic_) ? 1 : 0; }
  std::vector<RefusedSamples> refused() const override { return {}; }

 private:
  const LateNetwork& network_;
  std::string topic_;
};

class LateTransport final : public Transport {
 public:
  LateTransport(LateNetwork& network, std::string process)
      : network_{network}, process_{std::move(process)} {}
  Expected<std::unique_ptr<RemoteWriter>> advertise(const TopicSpec& topic) override {
    return std::make_unique<LateWriter>(network_, process_, topic.name);
  }
  Expected<std::unique_ptr<RemoteReader>> subscribe(
      const TopicSpec& topic, bool, std::function<void(SampleRef)> deliver) override {
    network_.readers[process_] = std::move(deliver);
    return std::make_unique<LateReader>(network_, topic.name);
  }

 private:
  LateNetwork& network_;
  std::string process_;
};

class CommonStartTest : public testing::Test {
 protected:
  std::optional<std::string> main_waits() {
    network_.deliver();
    return main_.waiting(Time{1});
  }
  std::optional<std::string> aside_waits() {
    network_.deliver();
    return aside_.waiting(Time{1});
  }

  LateNetwork network_;
  LateTransport of_main_{network_, "main"}, of_aside_{network_, "aside"};
  CommonStart main_{of_main_, "lamp", "main", {"aside"}};
  CommonStart aside_{of_aside_, "lamp", "aside", {"main"}};
};

TEST_F(CommonStartTest, WaitsUntilTheOtherProcessHasMetAllToo) {
  network_.has_met = network_.has_heard = {"main", "aside"};
  EXPECT_THAT(main_waits(),
              Optional(StrEq("process 'aside' has not met all that it exchanges topics with")));
  EXPECT_EQ(aside_waits(), std::nullopt);
  EXPECT_EQ(main_waits(), std::nullopt);
}

TEST_F(CommonStartTest, WaitsUntilTheOtherProcessHasHeardThatItHasMetAll) {
  network_.has_met = {"main", "aside"};
  network_.has_heard = {"main"};
  main_waits();
  EXPECT_THAT(aside_waits(),
              Optional(StrEq("process 'main' has not met all that it exchanges topics with")));
  EXPECT_THAT(main_waits(), Optional(StrEq("not every process has heard that 'main' has met all")));
  network_.has_heard = {"main", "aside"};
  EXPECT_EQ(main_waits(), std::nullopt);
  EXPECT_EQ(aside_waits(), std::nullopt);
}

TEST_F(CommonStartTest, WhoHasNotMetTheOtherOneDoesNotTakeItForInformed) {
  network_.has_met = {"aside"};
  network_.has_heard = {"main", "aside"};
  main_waits();
  aside_waits();
  EXPECT_THAT(main_waits(), Optional(StrEq("not every process has heard that 'main' has met all")));
  network_.has_met = {"main", "aside"};
  EXPECT_EQ(main_waits(), std::nullopt);
}

TEST_F(CommonStartTest, TheWordOfAProcessThatIsGoneIsNotThatOfWhoTakesItsPlace) {
  network_.has_met = {"aside"};
  network_.has_heard = {"main", "aside"};
  aside_waits();
  network_.deliver();
  EXPECT_FALSE(main_.all_have_met()) << "it has not met all itself";
  network_.gone = {"aside"};
  network_.deliver();
  EXPECT_FALSE(main_.all_have_met());
  network_.gone = {};
  network_.has_met = {"main", "aside"};
  EXPECT_THAT(main_waits(),
              Optional(StrEq("process 'aside' has not met all that it exchanges topics with")));
}

TEST_F(CommonStartTest, WhoHasSaidSoAndHeardAllBeginsThoughAnotherOneIsOverAlready) {
  network_.has_met = network_.has_heard = {"main", "aside"};
  main_waits();
  EXPECT_EQ(aside_waits(), std::nullopt);
  network_.deliver();
  EXPECT_TRUE(main_.all_have_met());
  network_.gone = {"aside"};
  EXPECT_TRUE(main_.all_have_met());
  EXPECT_EQ(main_.waiting(Time{2}), std::nullopt);
}

ComponentConfig component(const std::string& process, const std::vector<std::string>& reads,
                          const std::vector<std::string>& writes) {
  ComponentConfig made{.name = process, .process = process};
  for (const std::string& topic : reads) made.inputs.push_back({.spec = {}, .topic = topic});
  for (const std::string& topic : writes) made.outputs.push_back({.spec = {}, .topic = topic});
  return made;
}

TEST(ProcessesBoundTo, AreThoseThatItExchangesTopicsWithAlsoByWayOfOthers) {
  DeploymentConfig deployment;
  deployment.components = {component("arm", {"/a"}, {"/b"}), component("main", {"/b"}, {"/c"}),
                           component("eye", {}, {"/a"}), component("alone", {"/x"}, {"/y"})};
  EXPECT_EQ(processes_bound_to(deployment, "main"), (std::set<std::string>{"arm", "eye"}));
  EXPECT_EQ(processes_bound_to(deployment, "eye"), (std::set<std::string>{"arm", "main"}));
  EXPECT_TRUE(processes_bound_to(deployment, "alone").empty());
}

}  // namespace
}  // namespace armature
