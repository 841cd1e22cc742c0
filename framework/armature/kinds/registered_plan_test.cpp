// SPDX-License-Identifier: Apache-2.0
// A task that is watched: 1. which plan is its own, 2. which answer is the registration of that
// plan, in whatever order plan, question and answer come.
#include "armature/kinds/registered_plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>

#include "armature/runtime/testing/component_harness.hpp"

namespace armature {
namespace {

constexpr const char* kWatchesAPlan = R"(
armature_plugin: 1
id: test/watches_a_plan
kind: component
in:
  plan: {type: armature_msgs/NeedlePlan, reads: latest, qos: latched, doc: "Plans"}
  request: {type: armature_msgs/RegistrationRequest, reads: latest, doc: "Questions"}
  registration: {type: armature_msgs/RegistrationResponse, reads: queue(16), doc: "Answers"}
)";

class WatchesAPlan final : public Component {
 public:
  explicit WatchesAPlan(Setup& setup)
      : Component{setup},
        plan{setup.input<msg::NeedlePlan>("plan"), setup.input<msg::RegistrationRequest>("request"),
             setup.input<msg::RegistrationResponse>("registration")} {}
  void step(Time) override { news = plan.read(); }

  RegisteredPlan<msg::NeedlePlan> plan;
  RegisteredPlan<msg::NeedlePlan>::News news;
};

PluginRegistry with_watcher() {
  PluginRegistry plugins{std::vector<std::filesystem::path>{}};
  plugins.add<WatchesAPlan>(kWatchesAPlan);
  return plugins;
}

class RegisteredPlanTest : public ::testing::Test {
 protected:
  static msg::NeedlePlan plan_to(double z) {
    msg::NeedlePlan plan;
    plan.target_().z_(z);
    return plan;
  }
  void plan(double z) { harness_.send("plan", plan_to(z)); }
  void ask(std::uint64_t id, double z) {
    msg::RegistrationRequest question;
    question.request_id_(id);
    question.targets_() = {plan_to(z).target_(), plan_to(z).entry_()};
    harness_.send("request", question);
  }
  void answer(std::uint64_t id, bool valid = true) {
    msg::RegistrationResponse response;
    response.request_id_(id);
    response.valid_(valid);
    harness_.send("registration", response);
  }
  void step() { harness_.step(now_s_ += 0.1); }

  const WatchesAPlan& watcher() { return dynamic_cast<WatchesAPlan&>(harness_.component()); }
  double target_z() { return watcher().plan.plan()->target_().z_(); }
  /// The number of the question that it answers; 0 while there is none.
  std::uint64_t registered() {
    const auto* answer = watcher().plan.registration();
    return answer ? answer->request_id_() : 0;
  }

  PluginRegistry plugins_ = with_watcher();
  ComponentHarness harness_{plugins_, {.component = "{plugin: test/watches_a_plan}", .robot = {}}};
  double now_s_ = 0;
};

TEST_F(RegisteredPlanTest, IsRegisteredWhateverComesFirst) {
  std::array<int, 3> order{0, 1, 2};
  std::uint64_t id = 0;
  double z = 0;
  do {
    ++id;
    z += 0.01;
    for (const int what : order) {
      EXPECT_NE(registered(), id);
      if (what == 0) plan(z);
      if (what == 1) ask(id, z);
      if (what == 2) answer(id);
      step();
    }
    EXPECT_EQ(target_z(), z) << order[0] << order[1] << order[2];
    EXPECT_EQ(registered(), id) << order[0] << order[1] << order[2];
    EXPECT_TRUE(watcher().news.registration);
    step();
    EXPECT_FALSE(watcher().news.plan || watcher().news.registration);
  } while (std::ranges::next_permutation(order).found);
}

TEST_F(RegisteredPlanTest, StaysUntilTheTaskAsksForAnotherOne) {
  plan(0.01);
  ask(1, 0.01);
  answer(1);
  step();
  plan(0.02);
  step();
  EXPECT_EQ(target_z(), 0.01);
  EXPECT_EQ(registered(), 1u);
  ask(2, 0.02);
  step();
  EXPECT_EQ(target_z(), 0.02);
  EXPECT_EQ(registered(), 0u) << "what was registered is not of this plan";
  EXPECT_TRUE(watcher().news.plan && watcher().news.registration);
}

TEST_F(RegisteredPlanTest, HearsOnlyAnswersToTheTasksQuestionsThatTellARegistration) {
  plan(0.01);
  ask(4, 0.01);
  answer(4, false);
  answer(3);
  step();
  EXPECT_EQ(registered(), 0u);
  ask(5, 0.01);  // again
  answer(4);
  step();
  EXPECT_EQ(registered(), 4u);
  answer(5);
  step();
  EXPECT_EQ(registered(), 5u);
  for (std::uint64_t id = 6; id < 12; ++id) {
    ask(id, 0.01);
    answer(id, false);
    answer(100 + id);
    step();
  }
  EXPECT_EQ(registered(), 5u) << "what was refused since takes nothing away";
}

TEST_F(RegisteredPlanTest, IsTheOneThatWasAskedForThoughAnotherCameSince) {
  for (const double z : {0.01, 0.02, 0.03}) {
    plan(z);
    step();
  }
  ask(1, 0.02);
  answer(1);
  step();
  EXPECT_EQ(target_z(), 0.02);
  EXPECT_EQ(registered(), 1u);
}

}  // namespace
}  // namespace armature
