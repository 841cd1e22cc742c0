// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/instance_lock.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

namespace armature {
namespace {

const std::string kName = "lock_test_" + std::to_string(getpid());

TEST(InstanceLock, ASecondStartIsToldPidAndDomainOfTheFirst) {
  const auto first = InstanceLock::take(kName, 7);
  ASSERT_TRUE(first);
  const auto second = InstanceLock::take(kName, 7);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().text, "deployment '" + kName + "' already runs as pid " +
                                     std::to_string(getpid()) +
                                     " on domain 7; stop it, or use another domain with --domain");
}

TEST(InstanceLock, IsFreeAgainWhenTheFirstEnds) {
  { ASSERT_TRUE(InstanceLock::take(kName, 8)); }
  EXPECT_TRUE(InstanceLock::take(kName, 8));
}

TEST(InstanceLock, KeepsDomainsApart) {
  const auto first = InstanceLock::take(kName, 9);
  EXPECT_TRUE(InstanceLock::take(kName, 10));
}

}  // namespace
}  // namespace armature
