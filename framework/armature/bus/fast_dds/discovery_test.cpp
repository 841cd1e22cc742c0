// SPDX-License-Identifier: Apache-2.0
#include "armature/bus/fast_dds/discovery.hpp"

#include <gtest/gtest.h>

namespace armature {
namespace {

TEST(DiscoveryTest, AParticipantThatIsIgnoredIsForgottenWhenItIsGoneWithOrWithoutAGoodbye) {
  int told = 0;
  Discovery discovery{{.endpoint_found = {},
                       .is_peer = {},
                       .participant_lost = [&](const std::string&, bool) { ++told; }}};
  const GuidPrefix stranger{1};
  for (const bool lost : {false, true}) {
    EXPECT_TRUE(discovery.ignore(stranger));
    EXPECT_FALSE(discovery.ignore(stranger)) << "again";
    discovery.participant_gone(stranger, lost);
    EXPECT_FALSE(discovery.is_ignored(stranger)) << "lost: " << lost;
  }
  EXPECT_EQ(told, 0) << "nobody misses it";
}

}  // namespace
}  // namespace armature
