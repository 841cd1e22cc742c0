// SPDX-License-Identifier: Apache-2.0
// Jiang et al. 2021, sections 1.3 and 5: stereo, face normal, the simulated test, and every single
// figure of the reference's list of checks.
#include <gtest/gtest.h>

#include <map>

#include "armature/robot/geometry/stereo_camera.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "lamp_plugins.hpp"
#include "reference_file.hpp"

namespace armature::paper {
namespace {

using Eigen::Vector3d;

double angle_deg(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) / kDegree;
}

/// The camera that the printed figures were made with.
StereoCamera paper_camera() {
  const Figures camera = dental_lamp()["stereo"]["camera_reconstructed"];
  const Eigen::VectorXd size = camera["assumed_image"].numbers();
  return {.width = static_cast<int>(size[0]),
          .height = static_cast<int>(size[1]),
          .focal_px = 1000 / 1.27,
          .cx = camera["cu"].number(),
          .cy = camera["cv"].number(),
          .baseline_m = 1e-3 * camera["baseline_mm"].number()};
}

/// A stereo point of the reference in the paper's frame 7 [mm]: x depth, y up, z right, in the
/// middle between both cameras.
Vector3d seen(std::size_t i) {
  const Figures row = dental_lamp()["stereo"]["points"][i];
  const StereoCamera camera = paper_camera();
  const Vector3d left =
      camera.triangulate(row["left_px"].numbers().head<2>(), row["right_px"].numbers().head<2>());
  return 1e3 * Vector3d{left.z(), -left.y(), left.x() - 0.5 * camera.baseline_m};
}
constexpr std::size_t kLeftEye = 0, kRightEye = 1, kMouth = 2;

TEST(DentalLampVision, TriangulationGivesTheReferencePoints) {
  const Figures points = dental_lamp()["stereo"]["points"];
  ASSERT_EQ(points.size(), 3u);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3d wanted = points[i]["recomputed"].numbers().head<3>();
    EXPECT_LE((seen(i) - wanted).norm(), 2e-7) << points[i]["name"].text();
  }
}

TEST(DentalLampVision, TheFaceNormalIsTheCrossProductTowardsTheLamp) {
  const Vector3d ML = seen(kLeftEye) - seen(kMouth), MR = seen(kRightEye) - seen(kMouth);
  const Vector3d wanted =
      dental_lamp()["face_normal"]["cam_from_recomputed_points"].numbers().head<3>();
  EXPECT_LE((MR.cross(ML).normalized() - wanted).norm(), 2e-7);
}

TEST(DentalLampVision, TheSimulatedTestOfSection5Fits) {
  const Figures test = dental_lamp()["vrep_test"];
  const JointVector start = lamp().to_independent(kDegree * test["start_q_deg"].numbers()).value();
  EXPECT_LE((forward_kinematics(lamp(), start).translation() - test["start_P7"].point_m()).norm(),
            1e-9);
  const Vector3d mouth = test["small_sphere_mouth"].point_m();
  const Vector3d normal{-std::sqrt(3) / 2, 0, 0.5};
  EXPECT_LE((normal - Vector3d{test["normal"]["recomputed"].numbers().head<3>()}).norm(), 1e-7);
  const Vector3d lamp_at = test["big_sphere"].point_m();
  const JointVector goal = paper_joints(lamp_at, (mouth - lamp_at).normalized());
  EXPECT_LE((all_joints(goal) - test["ideal_goal_q"].numbers()).cwiseAbs().maxCoeff(), 1e-6);
  const Vector3d measured = test["normal_measured"].numbers().head<3>();
  EXPECT_NEAR(angle_deg(measured, normal),
              test["normal_error_deg"]["with_exact_sqrt3_over_2"].number(), 1e-5);
}

/// How far in front of the base joint 6 may be when link 1 stands on +y, the balance arm is level
/// and the lamp is turned by `heading`: where the closed form's q1 becomes 90 degrees [mm].
double search_limit_mm(double heading) {
  const Vector3d direction{std::cos(heading), std::sin(heading), 0};
  double near = 0.4, far = 0.95;
  for (int i = 0; i < 60; ++i) {
    const double x = 0.5 * (near + far);
    const Vector3d lamp_at = Vector3d{x, 0, 0.50407} + 0.08 * direction;
    (paper_joints(lamp_at, direction)[0] > 90 * kDegree ? near : far) = x;
  }
  return 1e3 * near;
}

/// The mouth's y for which (43) gives the printed P1 [mm].
double reconstructed_mouth_y_mm() {
  const Figures path = dental_lamp()["path"];
  const Vector3d P0 = path["inputs"]["P0"].numbers().head<3>();
  Vector3d m = path["m"]["printed"].numbers().head<3>();
  const double P1_y = path["P1"]["printed"].numbers()[1];
  for (int i = 0; i < 100; ++i) m.y() = P1_y / (1 - 500 / (P0 - m).norm());
  return m.y();
}

using Values = std::map<std::pair<std::string, std::string>, double>;

void add_kinematics(Values& values) {
  const Figures target = dental_lamp()["ik_example"]["target"];
  const Vector3d n = target["face_normal"].numbers().head<3>();
  const JointVector q = paper_joints(target["P"].point_m(), -n);
  const Eigen::Isometry3d pose = forward_kinematics(lamp(), q);
  for (int i = 0; i < 6; ++i) {
    values[{"(40)", "theta" + std::to_string(i + 1)}] = all_joints(q)[i];
  }
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      values[{"(41)", "T[" + std::to_string(row) + "][" + std::to_string(column) + "]"}] =
          (column == 3 ? 1e3 : 1) * pose(row, column);
    }
  }
  values[{"(42)", "|n|"}] = n.norm();
  const Vector3d P0 = forward_kinematics(lamp(), JointVector::Zero(5)).translation();
  values[{"sec 4.4", "P0.x at theta=0"}] = 1e3 * P0.x();
  values[{"sec 4.4", "P0.z at theta=0"}] = 1e3 * P0.z();
  values[{"Fig 15", "left limit"}] = search_limit_mm(40 * kDegree);
  values[{"Fig 16", "middle limit"}] = search_limit_mm(0);
  values[{"Fig 17", "right limit"}] = search_limit_mm(-40 * kDegree);
}

void add_path(Values& values) {
  const std::array<const char*, 3> axes{".x", ".y", ".z"};
  const std::array<const char*, 3> equations{"(55)", "(56)", "(57)"};
  for (std::size_t k = 0; k < 3; ++k) {
    const ToolPose& point = mouth_points()[k];
    const std::string name = "P" + std::to_string(k + 1);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      values[{"sec 4.4 (43)-(47)", name + axes[i]}] = 1e3 * point.position[axis];
      values[{"sec 4.4 (44)-(47)", name + "_dir" + axes[i]}] = direction_of(point)[axis];
      values[{"sec 4.4 (44)-(47)", std::string{"n"} + axes[i]}] = example().n[axis];
    }
    const JointVector q = all_joints(paper_joints(point.position, direction_of(point)));
    for (int i = 0; i < 6; ++i) {
      values[{equations[k], "theta" + std::to_string(i + 1) + "(" + name + ")"}] = q[i];
    }
  }
  values[{"sec 4.4", "m.y"}] = reconstructed_mouth_y_mm();
  values[{"sec 4.4", "angle P0-P3 directions"}] = angle_deg(example().u0, -example().n);
  const Largest grid = largest_errors(paper_trajectory(), 1, 3, 0.1);
  const Largest all = largest_errors(paper_trajectory(), 1, 3, 1e-4);
  values[{"abstract, Table 3", "max distance error (0.1 s grid)"}] = grid.distance_error_mm;
  values[{"abstract, Table 2", "max direction error (0.1 s grid)"}] = grid.aim_deg;
  values[{"-", "max distance error (continuous)"}] = all.distance_error_mm;
  values[{"-", "max direction error (continuous)"}] = all.aim_deg;
}

void add_simulated_test(Values& values) {
  const Figures test = dental_lamp()["vrep_test"];
  const Vector3d mouth = test["small_sphere_mouth"].numbers().head<3>();
  const Vector3d error = Vector3d{test["mouth_measured"].numbers().head<3>()} - mouth;
  const Eigen::Matrix3d photo =  // Rx(0) Ry(-60 deg) Rz(-90 deg)
      (Eigen::AngleAxisd{-60 * kDegree, Vector3d::UnitY()} *
       Eigen::AngleAxisd{-90 * kDegree, Vector3d::UnitZ()})
          .toRotationMatrix();
  values[{"sec 5", "photo normal z"}] = photo(2, 2);
  values[{"sec 5", "sphere distance"}] =
      (mouth - Vector3d{test["big_sphere"].numbers().head<3>()}).norm();
  values[{"sec 5", "mouth error x"}] = error.x();
  values[{"sec 5", "mouth error norm"}] = error.norm();
  values[{"sec 5", "normal deviation"}] =
      angle_deg(test["normal_measured"].numbers().head<3>(),
                test["normal_error_deg"]["against"].numbers().head<3>());
  values[{"sec 5", "mouth x"}] = seen(kMouth).x();
  values[{"sec 5", "mouth y"}] = seen(kMouth).y();
  values[{"sec 5", "mouth z"}] = seen(kMouth).z();
  values[{"sec 5", "eyes x"}] = seen(kLeftEye).x();
  values[{"sec 5", "left eye y"}] = seen(kLeftEye).y();
  values[{"sec 5", "left eye z"}] = seen(kLeftEye).z();
  values[{"sec 5", "right eye y"}] = seen(kRightEye).y();
  values[{"sec 5", "right eye z"}] = seen(kRightEye).z();
}

TEST(DentalLampChecks, EveryFigureOfTheListHolds) {
  Values values;
  add_kinematics(values);
  add_path(values);
  add_simulated_test(values);
  const Figures checks = dental_lamp()["checks"];
  ASSERT_EQ(checks.size(), 82u);
  for (std::size_t i = 0; i < checks.size(); ++i) {
    const std::pair key{checks[i]["where"].text(), checks[i]["quantity"].text()};
    SCOPED_TRACE(key.first + " " + key.second);
    const auto found = values.find(key);
    ASSERT_NE(found, values.end());
    EXPECT_NEAR(found->second, checks[i]["recomputed"].number(), checks[i]["tol"].number());
  }
}

}  // namespace
}  // namespace armature::paper
