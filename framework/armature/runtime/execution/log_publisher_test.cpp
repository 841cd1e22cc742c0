// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/execution/log_publisher.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "armature/messages/stamp.hpp"
#include "armature/runtime/testing/fake_setup.hpp"

namespace armature {
namespace {

using State = StatusReporter::State;

class LogPublisherTest : public testing::Test, private Subscriber {
 protected:
  LogPublisherTest() { setup_.topic("log").connect(*this); }
  std::vector<msg::Log> published() {
    publisher_.step(Time{} + seconds(9));
    return std::exchange(published_, {});
  }
  LogQueue queue_;

 private:
  void deliver(const SampleRef& sample) override {
    published_.push_back(*static_cast<const msg::Log*>(sample.message()));
  }
  ComponentRunner own_{"runtime_log", "runtime/log_publisher", 3, {}};
  FakeSetup setup_{own_};
  LogPublisher publisher_{setup_, "lamp", queue_};
  std::vector<msg::Log> published_;
};

TEST_F(LogPublisherTest, PublishesWhatWasSaidAsRosToolsReadIt) {
  queue_.put(Time{} + seconds(1.5), "motion", "reached the mouth", State::ok);
  queue_.put(Time{} + seconds(1.6), "camera", "degraded: no light", State::degraded);
  queue_.put(Time{} + seconds(1.7), "arm", "fault: no power", State::fault);
  queue_.put(Time{} + seconds(1.8), "arm", "stalled", State::stalled);
  const std::vector<msg::Log> lines = published();
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_EQ(lines[0].name_(), "lamp.motion");
  EXPECT_EQ(lines[0].msg_(), "reached the mouth");
  EXPECT_EQ(stamp_of(lines[0].stamp_()), Time{} + seconds(1.5));
  std::vector<int> levels;
  for (const msg::Log& line : lines) levels.push_back(line.level_());
  EXPECT_EQ(levels, (std::vector<int>{20, 30, 40, 40})) << "INFO, WARN, ERROR of rcl_interfaces";
  EXPECT_TRUE(published().empty()) << "once each";
}

TEST_F(LogPublisherTest, KeepsTheNewestLinesWhenMoreAreSaidThanItCanPublish) {
  constexpr int kSaid = 3 * static_cast<int>(LogQueue::kCapacity);
  for (int i = 0; i < kSaid; ++i) queue_.put({}, "arm", std::to_string(i), State::ok);
  const std::vector<msg::Log> lines = published();
  ASSERT_EQ(lines.size(), LogQueue::kCapacity);
  EXPECT_EQ(lines.front().msg_(), std::to_string(kSaid - static_cast<int>(LogQueue::kCapacity)));
  EXPECT_EQ(lines.back().msg_(), std::to_string(kSaid - 1));
}

TEST_F(LogPublisherTest, CutsALineThatIsTooLong) {
  queue_.put({}, "arm", std::string(10'000, 'x'), State::ok);
  const std::vector<msg::Log> lines = published();
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_FALSE(lines[0].msg_().empty());
  EXPECT_LE(lines[0].msg_().size(), StatusReporter::kMaxText);
}

}  // namespace
}  // namespace armature
