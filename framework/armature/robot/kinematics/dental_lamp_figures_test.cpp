// SPDX-License-Identifier: Apache-2.0
// The paper's figures that concern kinematics alone: Jiang et al. 2021, (40), (41), the face
// search.
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/robot/model/test_robots.hpp"

namespace armature {
namespace {

using Eigen::Vector3d;
using Row = std::vector<double>;

const YAML::Node& reference() {
  static const YAML::Node document = YAML::LoadFile(
      std::string{ARMATURE_SOURCE_DIR}.append("/tests/data/dental_lamp_reference.yaml"));
  return document;
}

JointVector all_joints(const Row& row) {
  return Eigen::Map<const Eigen::VectorXd>(row.data(), static_cast<Eigen::Index>(row.size()));
}

Eigen::Isometry3d pose_of(const RobotModel& lamp, const Row& all) {
  return forward_kinematics(lamp, lamp.to_independent(all_joints(all)).value());
}

TEST(DentalLampFigures, ForwardKinematicsGivesEveryEntryOfEveryCase) {
  const RobotModel lamp = testing::dental_lamp();
  ASSERT_EQ(reference()["fk_cases"].size(), 4u);
  for (const YAML::Node& figure : reference()["fk_cases"]) {
    SCOPED_TRACE(figure["name"].as<std::string>());
    const Eigen::Isometry3d T = pose_of(lamp, figure["q"].as<Row>());
    const auto rows = figure["T"].as<std::vector<Row>>();
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 4; ++c)
        EXPECT_NEAR(T(r, c) * (c == 3 ? 1000 : 1),
                    rows[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)], 1e-8)
            << r << ", " << c;
  }
}

TEST(DentalLampFigures, ArcAndSearchPosesAreWhereTheirAnglesPutTheLamp) {
  const RobotModel lamp = testing::dental_lamp();
  for (const YAML::Node& figure : reference()["arc_reference"]) {
    const Eigen::Isometry3d T = pose_of(lamp, figure["q"].as<Row>());
    EXPECT_LT((T.translation() * 1000 - Vector3d{figure["P"].as<Row>().data()}).norm(), 3e-6);
    EXPECT_LT((T.linear().col(0) - Vector3d{figure["x7"].as<Row>().data()}).norm(), 3e-9);
  }
  for (const YAML::Node& figure : reference()["face_search"]["poses"]) {
    const Eigen::Isometry3d T = pose_of(lamp, figure["q"].as<Row>());
    EXPECT_LT((T.translation() * 1000 - Vector3d{figure["P7"].as<Row>().data()}).norm(), 2e-4);
  }
}

/// The angles of P0, P1, P2, P3 at full precision.
}  // namespace
}  // namespace armature
