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

TEST_F(FastDds, APeerCountsWhileItIsThereAndAnotherOneOfItsNameInItsPlace) {
  const auto transport = make_transport();
  const auto reader = transport->subscribe(command_, true, collect()).value();
  for (int life = 0; life < 2; ++life) {
    Peer peer{domain_, "lamp", "f00d", "talk"};
    EXPECT_TRUE(eventually([&] { return reader->peers() == 1; }));
    EXPECT_EQ(peer.end(), 0);
    EXPECT_TRUE(eventually([&] { return reader->peers() == 0; }));
  }
}

TEST_F(FastDds, AReaderThatIsHaltedIsKnownByNameAndAcknowledgesNothingUntilItGoesOn) {
  const Peer peer{domain_, "lamp", "f00d", "echo"};
  const auto transport = make_transport();
  const auto writer = transport->advertise(to_peer_).value();
  ASSERT_TRUE(eventually([&] { return writer->matched_readers() == 1; }));
  writer->offer(sample(1));
  EXPECT_TRUE(writer->acknowledged(seconds(10)));
  ASSERT_EQ(writer->who_watches().size(), 1u);
  const Watcher watcher = writer->who_watches().front();
  EXPECT_TRUE(watcher.of_deployment);
  EXPECT_THAT(watcher.owner,
              testing::StartsWith("deployment 'lamp' (pid " + std::to_string(peer.pid()) + " on "));
  kill(peer.pid(), SIGSTOP);
  writer->offer(sample(2));
  EXPECT_FALSE(writer->acknowledged(seconds(0.3)));
  kill(peer.pid(), SIGCONT);
  EXPECT_TRUE(writer->acknowledged(seconds(1e10))) << "longer than DDS can count";
}

}  // namespace
}  // namespace armature
