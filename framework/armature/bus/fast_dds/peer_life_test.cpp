// SPDX-License-Identifier: Apache-2.0
// A process that is killed is noticed, one that ends properly is not missed.
#include <gmock/gmock.h>

#include "armature/bus/fast_dds/fast_dds_test.hpp"

namespace armature {
namespace {

TEST_F(FastDds, AKilledProcessIsNoticed) {
  Peer peer{domain_, "lamp", "f00d", "talk"};
  const auto transport = make_transport();
  const auto reader = transport->subscribe(command_, true, collect()).value();
  ASSERT_TRUE(eventually([&] { return received() > 0; }));
  EXPECT_EQ(events(Kind::peer_lost), 0);
  const std::string pid = std::to_string(peer.pid());
  peer.kill_now();
  EXPECT_THAT(event(Kind::peer_lost),
              testing::MatchesRegex("the writer on '/test/from_peer' of deployment 'lamp' \\(pid " +
                                    pid + " on [^)]+\\) fell silent: its process died or hangs"));
  EXPECT_TRUE(eventually([&] { return reader->writers() == 0; }));
}

TEST_F(FastDds, AProcessThatEndsProperlyIsNotMissed) {
  Peer peer{domain_, "lamp", "f00d", "talk"};
  const auto transport = make_transport();
  const auto reader = transport->subscribe(command_, true, collect()).value();
  ASSERT_TRUE(eventually([&] { return received() > 0; }));
  EXPECT_EQ(peer.end(), 0);
  EXPECT_TRUE(eventually([&] { return reader->writers() == 0; }));
  EXPECT_EQ(events(Kind::peer_lost), 0);
}

}  // namespace
}  // namespace armature
