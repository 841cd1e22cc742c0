// SPDX-License-Identifier: Apache-2.0
#include "follow.hpp"

#include <gtest/gtest.h>

namespace armature::test {
namespace {

TEST(LampFollows, APatientWhoMoves50MillimetresAndTurns10DegreesWithinOneSecond) {
  expect_followed({.move_mm = "[0,50,0]", .tilt_side_deg = 10});
}

}  // namespace
}  // namespace armature::test
