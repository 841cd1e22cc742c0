// SPDX-License-Identifier: Apache-2.0
// A lost process is told once: 1. by one process, 2. for all that is heard of it, 3. each of them.
#include "armature/runtime/deployment/lost_peers.hpp"

#include <gtest/gtest.h>

namespace armature {
namespace {

const std::string kFellSilent = " fell silent: its process died or hangs";

std::string participant(const std::string& process, int pid) {
  return "participant 'armature lamp, process '" + process + "'' (pid " + std::to_string(pid) +
         " on vm)" + kFellSilent;
}
std::string writer(const std::string& topic, const std::string& process, int pid) {
  return "the writer on '" + topic + "' of deployment 'lamp', process '" + process + "' (pid " +
         std::to_string(pid) + " on vm)" + kFellSilent;
}

LostPeers peers_of(const std::string& process) {
  return {"lamp", {"main", "arm", "vision"}, process};
}

TEST(LostPeers, TheMainProcessTellsOfAllOthers) {
  EXPECT_TRUE(peers_of("main").is_told_here(participant("vision", 7)));
  EXPECT_TRUE(peers_of("main").is_told_here(participant("arm", 7)));
  EXPECT_FALSE(peers_of("arm").is_told_here(participant("vision", 7)));
  EXPECT_FALSE(peers_of("vision").is_told_here(participant("arm", 7)));
}

TEST(LostPeers, TheOneBehindTheMainProcessTellsOfThat) {
  EXPECT_TRUE(peers_of("arm").is_told_here(participant("main", 7)));
  EXPECT_FALSE(peers_of("vision").is_told_here(participant("main", 7)));
}

TEST(LostPeers, TheMainProcessTellsOfProgramsThatAreNotTheDeployments) {
  const std::string rviz = "participant 'rviz' (pid 9 on vm)" + kFellSilent;
  EXPECT_TRUE(peers_of("main").is_told_here(rviz));
  EXPECT_FALSE(peers_of("arm").is_told_here(rviz));
  EXPECT_TRUE(
      peers_of("main").is_told_here("participant 'armature other, process 'main'' (pid 8 on "
                                    "vm)" +
                                    kFellSilent));
}

TEST(LostPeers, AllThatIsHeardOfOneProcessIsToldOnce) {
  LostPeers peers = peers_of("main");
  EXPECT_TRUE(peers.is_told_here(writer("/lamp/arm/servo_jp", "vision", 7)));
  EXPECT_FALSE(peers.is_told_here(writer("/lamp/goal", "vision", 7)));
  EXPECT_FALSE(peers.is_told_here(participant("vision", 7)));
  EXPECT_TRUE(peers.is_told_here(participant("arm", 8))) << "it is another one";
  EXPECT_TRUE(peers.is_told_here("something" + kFellSilent));
  EXPECT_FALSE(peers.is_told_here("something" + kFellSilent));
}

}  // namespace
}  // namespace armature
