// SPDX-License-Identifier: Apache-2.0
// Lines cross whole in both directions, nothing waits, and an end that is gone is known.
#include "armature/runtime/processes/control_channel.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>

namespace armature {
namespace {

TEST(ControlChannel, LinesCrossWholeAndInOrder) {
  auto [ours, theirs] = SocketChannel::make();
  ours.send("start");
  ours.send("stop the scenario is over");
  EXPECT_EQ(theirs.receive(), "start");
  EXPECT_EQ(theirs.receive(), "stop the scenario is over");
  EXPECT_EQ(theirs.receive(), std::nullopt);
  EXPECT_FALSE(theirs.lost());
  theirs.send("ready");
  EXPECT_EQ(ours.receive(), "ready");
}

TEST(ControlChannel, AnEndThatIsGoneIsKnownWhenItsLastLineHasBeenRead) {
  std::optional<std::pair<SocketChannel, SocketChannel>> ends{SocketChannel::make()};
  SocketChannel theirs{std::move(ends->second)};
  ends->first.send("end");
  ends.reset();
  EXPECT_EQ(theirs.receive(), "end");
  EXPECT_FALSE(theirs.lost());
  EXPECT_EQ(theirs.receive(), std::nullopt);
  EXPECT_TRUE(theirs.lost());
  theirs.send("to nobody");
}

TEST(ControlChannel, TheLinesOfAnEndThatIsGoneAreReadAlsoWhenItLeftOursUnread) {
  auto [ours, theirs] = SocketChannel::make();
  {
    SocketChannel gone{std::move(theirs)};
    gone.send("fault 'beat' hangs");
    gone.send("timing late");
    ours.send("stop");
  }
  EXPECT_EQ(ours.receive(), "fault 'beat' hangs");
  EXPECT_EQ(ours.receive(), "timing late");
  EXPECT_FALSE(ours.lost());
  EXPECT_EQ(ours.receive(), std::nullopt);
  EXPECT_TRUE(ours.lost());
}

TEST(ControlChannel, AFullOneLosesLinesInsteadOfWaiting) {
  auto [ours, theirs] = SocketChannel::make();
  for (int i = 0; i < 10000; ++i) ours.send(std::string(4000, 'x'));
  EXPECT_EQ(theirs.receive(), std::string(4000, 'x'));
}

TEST(ControlChannel, WithoutAnOtherEndNothingIsHeardOrLost) {
  SocketChannel none;
  none.send("hello");
  EXPECT_EQ(none.receive(), std::nullopt);
  EXPECT_FALSE(none.lost());
}

}  // namespace
}  // namespace armature
