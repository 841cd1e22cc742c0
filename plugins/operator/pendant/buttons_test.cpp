// SPDX-License-Identifier: Apache-2.0
#include "buttons.hpp"

#include <gtest/gtest.h>

#include "event_pipe_test.hpp"

namespace armature::operator_::pendant {
namespace {

constexpr int kTrigger = BTN_TRIGGER, kThumb = BTN_THUMB;

class ButtonsTest : public testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(buttons_.update(), ""); }
  test::EventPipe device_;
  Buttons buttons_{device_.path()};
};

TEST_F(ButtonsTest, AButtonIsHeldFromGoingDownToGoingUp) {
  device_.press(kTrigger);
  ASSERT_EQ(buttons_.update(), "");
  EXPECT_TRUE(buttons_.held(kTrigger));
  EXPECT_TRUE(buttons_.pressed(kTrigger));
  EXPECT_FALSE(buttons_.held(kThumb));
  ASSERT_EQ(buttons_.update(), "");
  EXPECT_TRUE(buttons_.held(kTrigger));
  EXPECT_FALSE(buttons_.pressed(kTrigger)) << "that was before";
  device_.release(kTrigger);
  ASSERT_EQ(buttons_.update(), "");
  EXPECT_FALSE(buttons_.held(kTrigger));
}

TEST_F(ButtonsTest, ButtonsThatGoDownAndUpBetweenTwoLooksWerePressed) {
  device_.press(kThumb);
  device_.release(kThumb);
  ASSERT_EQ(buttons_.update(), "");
  EXPECT_TRUE(buttons_.pressed(kThumb));
  EXPECT_FALSE(buttons_.held(kThumb));
}

TEST_F(ButtonsTest, AButtonThatWasLetGoForAMomentIsNotHeldForOneLook) {
  device_.press(kTrigger);
  ASSERT_EQ(buttons_.update(), "");
  device_.release(kTrigger);
  device_.press(kTrigger);
  ASSERT_EQ(buttons_.update(), "");
  EXPECT_FALSE(buttons_.held(kTrigger));
  ASSERT_EQ(buttons_.update(), "");
  EXPECT_TRUE(buttons_.held(kTrigger));
}

TEST_F(ButtonsTest, AButtonThatWasLetGoIsSeenAtOnceBehindHowManyEventsItMayBe) {
  device_.press(kTrigger);
  ASSERT_EQ(buttons_.update(), "");
  for (int i = 0; i < 300; ++i) device_.send(EV_ABS, 0, i);
  device_.release(kTrigger);
  ASSERT_EQ(buttons_.update(), "");
  EXPECT_FALSE(buttons_.held(kTrigger));
}

TEST_F(ButtonsTest, AButtonThatWasDownBeforeAnybodyLookedIsNotHeld) {
  device_.send(EV_KEY, kTrigger, 2);  // it repeats by itself
  ASSERT_EQ(buttons_.update(), "");
  EXPECT_FALSE(buttons_.held(kTrigger));
  EXPECT_FALSE(buttons_.pressed(kTrigger));
}

TEST_F(ButtonsTest, NoButtonIsHeldWhenEventsWereLost) {
  device_.press(kTrigger);
  device_.send(EV_SYN, SYN_DROPPED, 0);
  ASSERT_EQ(buttons_.update(), "");
  EXPECT_FALSE(buttons_.held(kTrigger)) << "it may have been let go";
}

TEST_F(ButtonsTest, AxesAreNoButtons) {
  device_.send(EV_ABS, kTrigger, 1);
  device_.send(EV_KEY, KEY_CNT, 1);
  ASSERT_EQ(buttons_.update(), "");
  EXPECT_FALSE(buttons_.held(kTrigger));
}

TEST_F(ButtonsTest, NoButtonIsHeldOfADeviceThatIsGone) {
  device_.press(kTrigger);
  ASSERT_EQ(buttons_.update(), "");
  device_.unplug();
  EXPECT_EQ(buttons_.update(),
            "cannot read " + device_.path() + ": No such device; is it plugged in?");
  EXPECT_FALSE(buttons_.held(kTrigger));
  EXPECT_EQ(buttons_.update(),
            "cannot read " + device_.path() + ": No such file or directory; is it plugged in?");
  device_.plug_in();
  EXPECT_EQ(buttons_.update(), "");
  EXPECT_FALSE(buttons_.held(kTrigger)) << "it must be pressed again";
  device_.press(kTrigger);
  EXPECT_EQ(buttons_.update(), "");
  EXPECT_TRUE(buttons_.held(kTrigger));
}

TEST_F(ButtonsTest, SoManyEventsAtOnceAreReadOneCallAfterTheOther) {
  for (int i = 0; i < 70; ++i) device_.send(EV_ABS, ABS_X, i);
  device_.press(kTrigger);
  ASSERT_EQ(buttons_.update(), "");
  ASSERT_EQ(buttons_.update(), "");
  EXPECT_TRUE(buttons_.held(kTrigger));
}

}  // namespace
}  // namespace armature::operator_::pendant
