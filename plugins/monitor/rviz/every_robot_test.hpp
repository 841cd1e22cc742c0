// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "armature/robot/model/test_robots.hpp"

namespace armature::testing {

/// A test that is run with the lamp and with a robot of both conventions, slides and coupled
/// joints.
class EveryRobot : public ::testing::TestWithParam<const char*> {
 protected:
  static RobotModel robot() {
    const std::string name = GetParam();
    if (name == "DentalLamp") return dental_lamp();
    if (name == "Standard") return synthetic_robot(RobotModel::Convention::standard, 7);
    return synthetic_robot(RobotModel::Convention::modified, 8);
  }
};

inline const auto kEveryRobot = ::testing::Values("DentalLamp", "Standard", "Modified");

}  // namespace armature::testing
