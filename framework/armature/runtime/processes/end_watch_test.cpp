// SPDX-License-Identifier: Apache-2.0
// What does not return at the end of a process is named once, and nothing else is.
#include "armature/runtime/processes/end_watch.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <thread>

namespace armature {
namespace {

using std::chrono::milliseconds;

class EndWatchTest : public testing::Test {
 protected:
  std::promise<std::string> reported_;
  std::future<std::string> hung_ = reported_.get_future();
  bool hangs_within(milliseconds timeout) const {
    return hung_.wait_for(timeout) == std::future_status::ready;
  }
};

TEST_F(EndWatchTest, WhatDoesNotReturnIsNamed) {
  EndWatch watch{seconds(0.1), [this](const auto& text) { reported_.set_value(text); }};
  watch.begin("the stop of 'beat'");
  watch.begin("the stop of 'arm'");
  ASSERT_TRUE(hangs_within(milliseconds{20000}));
  EXPECT_EQ(hung_.get(), "the stop of 'arm' has not returned for 0.1 s");
  std::this_thread::sleep_for(milliseconds{200});  // a second word would throw
}

TEST_F(EndWatchTest, EachPartOfTheEndHasItsOwnTime) {
  EndWatch watch{seconds(1), [this](const auto& text) { reported_.set_value(text); }};
  for (int i = 0; i < 8; ++i) {
    watch.begin("the stop of 'arm'");
    std::this_thread::sleep_for(milliseconds{200});
  }
  EXPECT_FALSE(hangs_within(milliseconds{0}));
}

TEST_F(EndWatchTest, WhatHasNotBegunOrIsOverIsNotWatched) {
  {
    EndWatch watch{seconds(0.05), [this](const auto& text) { reported_.set_value(text); }};
    EXPECT_FALSE(hangs_within(milliseconds{150}));
    watch.begin("the stop of 'arm'");
  }
  EXPECT_FALSE(hangs_within(milliseconds{150}));
}

}  // namespace
}  // namespace armature
