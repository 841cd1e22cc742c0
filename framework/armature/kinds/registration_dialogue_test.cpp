// SPDX-License-Identifier: Apache-2.0
// A task's dialogue with a registration: 1. asked again in time, 2. whose answers count.
#include "armature/kinds/registration_dialogue.hpp"

#include <gtest/gtest.h>

#include "armature/messages/geometry_msgs.hpp"
#include "armature/runtime/testing/component_harness.hpp"

namespace armature {
namespace {

constexpr const char* kAsks = R"(
armature_plugin: 1
id: test/asks
kind: component
in:
  registration: {type: armature_msgs/RegistrationResponse, reads: queue(16), doc: "Answers"}
out:
  request: {type: armature_msgs/RegistrationRequest, doc: "Questions"}
)";
constexpr double kOthersFrom_s = 20;  // it asks about other targets

class Asks final : public Component {
 public:
  explicit Asks(Setup& setup)
      : Component{setup},
        dialogue_{setup.output<msg::RegistrationRequest>("request"),
                  setup.input<msg::RegistrationResponse>("registration"), 0.0005, 0.003} {}
  void step(Time now) override {
    const bool others = now >= Time{} + seconds(kOthersFrom_s);
    const std::vector<msg::Point> targets(others ? 3 : 2);
    if (dialogue_.due(now)) dialogue_.ask({.robot_frame = "jaw", .targets = targets}, now);
    dialogue_.listen([&](const msg::RegistrationResponse& answer) {
      log(answer.valid_() ? "registered" : answer.reason_());
    });
  }

 private:
  RegistrationDialogue dialogue_;
};

PluginRegistry with_asks() {
  PluginRegistry plugins{std::vector<std::filesystem::path>{}};
  plugins.add<Asks>(kAsks);
  return plugins;
}

msg::RegistrationResponse answer(std::uint64_t id, bool valid = true) {
  msg::RegistrationResponse response;
  response.request_id_(id);
  response.valid_(valid);
  response.reason_() = "too few";
  return response;
}

class RegistrationDialogueTest : public ::testing::Test {
 protected:
  std::vector<msg::RegistrationRequest> asked_at(double now_s) {
    task_.step(now_s);
    return task_.take<msg::RegistrationRequest>("request");
  }

  PluginRegistry plugins_ = with_asks();
  ComponentHarness task_{plugins_, {.component = "{plugin: test/asks}", .robot = {}}};
};

TEST_F(RegistrationDialogueTest, AsksAgainUnderANewNumberWhenNobodyAnswersWithinASecond) {
  const auto first = asked_at(10);
  ASSERT_EQ(first.size(), 1u);
  EXPECT_EQ(first[0].header_().frame_id_(), "jaw");
  EXPECT_FALSE(first[0].ordered_());
  EXPECT_DOUBLE_EQ(first[0].marker_error_(), 0.0005);
  EXPECT_DOUBLE_EQ(first[0].match_tolerance_(), 0.003);
  EXPECT_EQ(first[0].targets_().size(), 2u);
  EXPECT_TRUE(asked_at(10.9).empty());
  const auto second = asked_at(11);
  ASSERT_EQ(second.size(), 1u);
  EXPECT_NE(second[0].request_id_(), first[0].request_id_());
}

TEST_F(RegistrationDialogueTest, HearsOnlyTheAnswersToItsLastThreeQuestions) {
  task_.send("registration", answer(0));
  const std::uint64_t old = asked_at(10)[0].request_id_();
  const std::uint64_t late = asked_at(11)[0].request_id_();
  asked_at(12);
  const std::uint64_t last = asked_at(13)[0].request_id_();
  task_.send("registration", answer(old));
  task_.send("registration", answer(last + 1));
  task_.step(13.1);
  EXPECT_TRUE(task_.lines().empty());
  task_.send("registration", answer(late, false));
  task_.step(13.2);
  task_.send("registration", answer(last));
  task_.step(13.3);
  EXPECT_EQ(task_.lines(), (std::vector<std::string>{"too few", "registered"}));
}

TEST_F(RegistrationDialogueTest, HearsNoAnswerAboutOtherMarkersThanItAskedForLast) {
  const std::uint64_t old = asked_at(kOthersFrom_s - 1)[0].request_id_();
  const std::uint64_t newer = asked_at(kOthersFrom_s)[0].request_id_();
  task_.send("registration", answer(old, false));
  task_.step(kOthersFrom_s + 0.1);
  EXPECT_TRUE(task_.lines().empty());
  task_.send("registration", answer(newer));
  task_.step(kOthersFrom_s + 0.2);
  EXPECT_EQ(task_.lines(), std::vector<std::string>{"registered"});
}

}  // namespace
}  // namespace armature
