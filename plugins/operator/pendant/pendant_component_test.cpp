// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "armature/messages/std_msgs.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"
#include "event_pipe_test.hpp"

namespace armature::operator_::pendant {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class PendantTest : public testing::Test {
 protected:
  static ComponentHarness::Options pendant_with(const std::string& params) {
    return {.component = "{plugin: operator/pendant, params: {" + params + "}}", .robot = {}};
  }
  std::vector<bool> told(const char* output) {
    std::vector<bool> values;
    for (const auto& message : bench_.take<msg::Bool>(output)) values.push_back(message.data_());
    return values;
  }
  void step() { bench_.step(now_s_ += 0.02); }

  test::EventPipe device_;
  double now_s_ = 7;
  ComponentHarness bench_{built_plugins(), pendant_with("device: " + device_.path())};
};

TEST_F(PendantTest, TellsOnEveryStepWhetherTheButtonIsHeld) {
  step();
  device_.press(BTN_TRIGGER);
  step();
  step();
  device_.release(BTN_TRIGGER);
  step();
  EXPECT_THAT(told("hold_to_run"), ElementsAre(false, true, true, false));
  EXPECT_THAT(told("rearm"), IsEmpty());
}

TEST_F(PendantTest, RearmsOnceWhenThatButtonGoesDown) {
  step();
  device_.press(BTN_THUMB);
  step();
  step();
  device_.release(BTN_THUMB);
  step();
  EXPECT_THAT(told("rearm"), ElementsAre(true));
}

TEST_F(PendantTest, ADeviceThatIsGoneHoldsNothingIsToldAndIsTakenAgainWhenItComesBack) {
  device_.press(BTN_TRIGGER);
  step();
  device_.unplug();
  step();
  EXPECT_THAT(told("hold_to_run"), ElementsAre(true, false));
  EXPECT_EQ(bench_.status().state, StatusReporter::State::degraded);
  EXPECT_EQ(bench_.status().reason,
            "cannot read " + device_.path() + ": No such device; is it plugged in?");
  device_.plug_in();
  step();
  EXPECT_EQ(bench_.status().state, StatusReporter::State::degraded)
      << "it is looked for once a second";
  bench_.step(now_s_ += 1);
  EXPECT_EQ(bench_.status().state, StatusReporter::State::ok);
  device_.press(BTN_TRIGGER);
  told("hold_to_run");
  step();
  EXPECT_THAT(told("hold_to_run"), ElementsAre(true));
}

TEST_F(PendantTest, OneButtonForBothIsRefused) {
  EXPECT_EQ(refusal_of(built_plugins(), pendant_with("device: /dev/null, rearm_button: 288")),
            "bench:1:77: the button that is held cannot rearm: letting it go and pressing "
            "it again would do both");
}

}  // namespace
}  // namespace armature::operator_::pendant
