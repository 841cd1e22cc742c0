// SPDX-License-Identifier: Apache-2.0
// Jiang et al. 2021, sections 4.3 to 4.5: path points, quintics, tables 2 and 3.
#include <gtest/gtest.h>

#include "armature/robot/kinematics/kinematics.hpp"
#include "lamp_plugins.hpp"
#include "reference_file.hpp"

namespace armature::paper {
namespace {

double degrees_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) / kDegree;
}

TEST(DentalLampPath, PointsAndDirectionsAreThoseOfTheCorrectedFormulas) {
  const Figures path = dental_lamp()["path"];
  const auto& points = mouth_points();
  ASSERT_EQ(points.size(), 3u);
  const auto at = [](const Figures& figure) -> Eigen::Vector3d {
    return figure["recomputed"].numbers().head<3>();
  };
  EXPECT_LE((1e3 * points[0].position - at(path["P1"])).norm(), 2e-6);
  EXPECT_LE((1e3 * points[1].position - at(path["P2"])).norm(), 2e-6);
  EXPECT_LE((1e3 * points[2].position - at(path["P3_from_m_plus_dn"])).norm(), 2e-6);
  EXPECT_LE((example().n - at(path["n"])).norm(), 1e-6);
  EXPECT_LE((direction_of(points[0]) - at(path["u1"])).norm(), 1e-6);
  EXPECT_LE((direction_of(points[1]) - at(path["u2"])).norm(), 1e-6);
  EXPECT_LE((direction_of(points[2]) - at(path["u3"])).norm(), 1e-6);
}

TEST(DentalLampPath, AnglesBetweenTheDirectionsAreThoseOfTheReference) {
  const Figures angles = dental_lamp()["path"]["angles_deg"];
  const auto& points = mouth_points();
  const Eigen::Vector3d u1 = direction_of(points[0]), u2 = direction_of(points[1]),
                        u3 = direction_of(points[2]);
  EXPECT_NEAR(degrees_between(example().u0, u3), angles["u0_u3"]["recomputed"].number(), 1e-4);
  EXPECT_NEAR(degrees_between(u1, u3), angles["u1_u3"].number(), 1e-4);
  EXPECT_NEAR(degrees_between(u1, u2), angles["u1_u2"].number(), 1e-4);
  EXPECT_NEAR(degrees_between(u2, u3), angles["u2_u3"].number(), 1e-4);
  EXPECT_NEAR(degrees_between(example().u0, u1), angles["u0_to_mouth_at_P0"].number(), 1e-4);
}

TEST(DentalLampPath, JointsAtThePathPointsAreThoseOfTheReference) {
  const Figures theta = dental_lamp()["path"]["theta"];
  ASSERT_EQ(theta.size(), 4u);
  const Trajectory& plan = paper_trajectory();
  for (std::size_t i = 0; i < theta.size(); ++i) {
    const JointVector q = plan.at(plan.start + seconds(static_cast<double>(i))).q;
    EXPECT_LE((all_joints(q) - theta[i]["recomputed"].numbers()).cwiseAbs().maxCoeff(), 1e-7)
        << theta[i]["point"].text();
  }
}

TEST(DentalLampPath, QuinticsHaveTheReferencesCoefficients) {
  const Figures quintic = dental_lamp()["quintic"];
  const Trajectory& plan = paper_trajectory();
  ASSERT_EQ(plan.piece_count(), 3);
  const std::array<const char*, 3> names{"k1", "k2", "k3"};
  for (std::size_t k = 0; k < 3; ++k) {
    const Figures matrix = quintic[names[k]];
    for (std::size_t j = 0; j < 6; ++j) {
      const std::size_t independent = j < 3 ? j : j - 1;
      const double sign = j == 3 ? -1 : 1;  // joint 4 mirrors joint 3
      const auto& c = plan.pieces[k * 5 + independent].c;
      const auto column = static_cast<Eigen::Index>(j);
      for (std::size_t row = 0; row < 3; ++row) {
        const double wanted = matrix["recomputed_rows_456"][row].numbers()[column];
        EXPECT_NEAR(sign * c[3 + row], wanted, 1e-6) << names[k] << " joint " << j + 1;
        EXPECT_NEAR(sign * c[3 + row], matrix["printed"][3 + row].numbers()[column], 2.6e-3);
      }
    }
  }
}

TEST(DentalLampPath, Tables2And3AreReproduced) {
  const Figures tables = dental_lamp()["tables_2_3"];
  const double angle_tolerance = tables["tolerance"]["angle_deg"].number();
  const double distance_tolerance = tables["tolerance"]["distance_mm"].number();
  const Figures rows = tables["rows"];
  ASSERT_EQ(rows.size(), 20u);
  const Trajectory& plan = paper_trajectory();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Eigen::VectorXd row = rows[i].numbers();
    const Standing here = standing_at(plan.at(plan.start + seconds(row[0])).q);
    EXPECT_NEAR(here.aim_deg, row[1], angle_tolerance) << "t = " << row[0];
    EXPECT_NEAR(here.aim_deg, row[3], 1e-4) << "t = " << row[0];
    EXPECT_NEAR(here.distance_mm, row[4], distance_tolerance) << "t = " << row[0];
    EXPECT_NEAR(here.distance_mm, row[6], 1e-3) << "t = " << row[0];
  }
}

TEST(DentalLampPath, ThePapersMaximaAreThoseOfItsGridAndNotTheTrueOnes) {
  const Figures maxima = dental_lamp()["tables_2_3"]["maxima"];
  const Largest grid = largest_errors(paper_trajectory(), 1, 3, 0.1);
  const Largest true_ones = largest_errors(paper_trajectory(), 1, 3, 1e-4);
  EXPECT_NEAR(grid.distance_error_mm, maxima["distance_error_mm"]["at_0.1s_grid"].number(), 1e-3);
  EXPECT_NEAR(grid.aim_deg, maxima["angle_deg"]["at_0.1s_grid"].number(), 1e-4);
  EXPECT_NEAR(true_ones.distance_error_mm, maxima["distance_error_mm"]["true_continuous"].number(),
              1e-4);
  EXPECT_NEAR(true_ones.aim_deg, maxima["angle_deg"]["true_continuous"].number(), 1e-4);
}

}  // namespace
}  // namespace armature::paper
