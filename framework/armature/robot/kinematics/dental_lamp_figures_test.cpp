// SPDX-License-Identifier: Apache-2.0
// The paper's figures that concern kinematics and quintics: Jiang et al. 2021, (40)-(60), table
// 2, 3.
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/robot/model/test_robots.hpp"
#include "armature/robot/trajectories/quintic.hpp"

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
std::vector<Row> path_angles() {
  const YAML::Node arc = reference()["arc_reference"];
  return {Row(6, 0.0), arc[0]["q"].as<Row>(), arc[4]["q"].as<Row>(), arc[8]["q"].as<Row>()};
}

/// Segment `k` of the paper's path, joint `j`: one second, rest to rest.
Quintic segment(const std::vector<Row>& angles, std::size_t k, std::size_t j) {
  return Quintic::between({.q = angles[k][j]}, {.q = angles[k + 1][j]}, 1);
}

TEST(DentalLampFigures, QuinticsHaveTheRecomputedCoefficients) {
  const auto angles = path_angles();
  for (std::size_t k = 0; k < 3; ++k) {
    const auto rows = reference()["quintic"]["k" + std::to_string(k + 1)]["recomputed_rows_456"]
                          .as<std::vector<Row>>();
    for (std::size_t j = 0; j < 6; ++j) {
      const Quintic quintic = segment(angles, k, j);
      EXPECT_EQ(quintic.c[1], 0);
      EXPECT_EQ(quintic.c[2], 0);
      for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(quintic.c[3 + i], rows[i][j], 1e-6);
    }
  }
}

TEST(DentalLampFigures, QuinticsHaveThePrintedCoefficientsWithinThePrint) {
  const auto angles = path_angles();
  for (std::size_t k = 0; k < 3; ++k) {
    const YAML::Node figures = reference()["quintic"]["k" + std::to_string(k + 1)];
    const auto rows = figures["printed"].as<std::vector<Row>>();
    for (std::size_t j = 0; j < 6; ++j) {
      const Quintic quintic = segment(angles, k, j);
      for (std::size_t i = 0; i < 6; ++i)
        EXPECT_NEAR(quintic.c[i], rows[i][j], figures["max_abs_diff"].as<double>() + 1e-6);
    }
  }
}

TEST(DentalLampFigures, AlongTheQuinticsAngleAndDistanceAreThoseOfTables2And3) {
  const RobotModel lamp = testing::dental_lamp();
  const auto angles = path_angles();
  const Vector3d mouth{1925.8, 2.8966, 545};
  const YAML::Node tables = reference()["tables_2_3"];
  ASSERT_EQ(tables["rows"].size(), 20u);
  for (const YAML::Node& figure : tables["rows"]) {
    const auto row = figure.as<Row>();
    SCOPED_TRACE(::testing::Message() << "t = " << row[0]);
    const std::size_t k = row[0] < 2 ? 1 : 2;
    Row all(6);
    for (std::size_t j = 0; j < 6; ++j)
      all[j] = segment(angles, k, j).position(row[0] - static_cast<double>(k));
    const Eigen::Isometry3d T = pose_of(lamp, all);
    const Vector3d to_mouth = mouth - T.translation() * 1000;
    const Vector3d x7 = T.linear().col(0);
    const double angle_deg =
        std::atan2(x7.cross(to_mouth).norm(), x7.dot(to_mouth)) * 180 / std::numbers::pi;
    EXPECT_NEAR(angle_deg, row[1], tables["tolerance"]["angle_deg"].as<double>());
    EXPECT_NEAR(angle_deg, row[3], 6e-5);
    EXPECT_NEAR(to_mouth.norm(), row[4], tables["tolerance"]["distance_mm"].as<double>());
    EXPECT_NEAR(to_mouth.norm(), row[6], 6e-4);
  }
}

}  // namespace
}  // namespace armature
