// SPDX-License-Identifier: Apache-2.0
// Jiang et al. 2021: the auto-tracking dental lamp. In the paper's millimetres.
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "armature/robot/geometry/stereo_camera.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/values/angles.hpp"
#include "reproduce/experiment.hpp"
#include "reproduce/lamp_detection.hpp"
#include "reproduce/lamp_example.hpp"
#include "reproduce/papers.hpp"

namespace armature::reproduce {
namespace {

using Eigen::Vector3d;

std::string theta(int i) { return "theta" + std::to_string(i + 1); }

/// (40) to (42).
void add_inverse(const Numbers& numbers, LampExample& lamp, Results& results) {
  const std::string table = "equations_40_42";
  const Vector3d n = numbers["equation_40"]["face_normal"].numbers();
  const JointVector q = lamp.joints(numbers["equation_40"]["P"].point_m(), -n);
  const Eigen::Isometry3d pose = forward_kinematics(lamp.model(), q);
  for (int i = 0; i < 6; ++i) results.value(table, theta(i), lamp.all_joints(q)[i]);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      results.value(table, "T[" + std::to_string(row) + "][" + std::to_string(column) + "]",
                    (column == 3 ? 1e3 : 1) * pose(row, column));
    }
  }
  results.value(table, "|n|", n.norm());
}

/// The mouth's y for which (43) gives the printed P1 [mm].
double inferred_mouth_y_mm(const Numbers& example) {
  const Vector3d P0 = example["P0"].numbers();
  Vector3d m = example["m_printed"].numbers();
  for (int i = 0; i < 100; ++i) {
    m.y() = example["P1_y_printed"].number() / (1 - 500 / (P0 - m).norm());
  }
  return m.y();
}

/// (43) to (47), (55) to (57).
void add_points(const Numbers& numbers, LampExample& lamp, Results& results) {
  const std::string table = "section_4_4";
  const Vector3d at_zero =
      forward_kinematics(lamp.model(), JointVector::Zero(lamp.model().dof())).translation();
  results.value(table, "P0.x at theta=0", 1e3 * at_zero.x());
  results.value(table, "P0.z at theta=0", 1e3 * at_zero.z());
  results.value(table, "m.y", inferred_mouth_y_mm(numbers["example"]));
  results.point(table, "n", lamp.n);
  const std::vector<ToolPose> points = lamp.mouth_points();
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::string name = "P" + std::to_string(k + 1);
    results.point(table, name, 1e3 * points[k].position);
    results.point(table, name + "_dir", direction_of(points[k]));
    const JointVector q = lamp.all_joints(lamp.joints(points[k]));
    for (int i = 0; i < 6; ++i) results.value(table, theta(i) + "(" + name + ")", q[i]);
  }
  results.value(table, "angle P0-P3 directions", angle_between(lamp.u0, -lamp.n) / kRadPerDegree);
}

/// (58) to (60): a piece of a second for each of the three moves.
void add_quintics(const Trajectory& plan, Results& results) {
  for (std::size_t k = 0; k < 3; ++k) {
    for (int i = 0; i < 6; ++i) {
      const auto independent = static_cast<std::size_t>(i < 3 ? i : i - 1);
      const double sign = i == 3 ? -1 : 1;  // theta4 = -theta3
      const auto& c = plan.pieces[k * 5 + independent].c;
      for (std::size_t power = 3; power <= 5; ++power) {
        results.value("equations_58_60",
                      "k" + std::to_string(k + 1) + " " + theta(i) + " s^" + std::to_string(power),
                      sign * c[power]);
      }
    }
  }
}

/// Tables 2 and 3: from P1 on, on the paper's grid and at all times.
void add_errors(const LampExample& lamp, const Trajectory& plan, Results& results) {
  for (int i = 10; i < 30; ++i) {
    const LampExample::Standing here = lamp.standing_at(plan.at(plan.start + seconds(0.1 * i)).q);
    const std::string row = "t = " + std::to_string(i / 10) + "." + std::to_string(i % 10) + " s";
    results.value("table_2", row, here.aim_deg);
    results.value("table_3", row, here.distance_mm);
  }
  const LampExample::Largest grid = lamp.largest_errors(plan, 1, 3, 0.1);
  const LampExample::Largest all = lamp.largest_errors(plan, 1, 3, 1e-4);
  results.value("table_2", "largest of the table", grid.aim_deg);
  results.value("table_2", "largest of all times", all.aim_deg);
  results.value("table_3", "largest error of the table", grid.distance_error_mm);
  results.value("table_3", "largest error of all times", all.distance_error_mm);
}

/// Figures 15 to 17: links seen from above.
void add_search(LampExample& lamp, Results& results) {
  struct View {
    const char* name;
    double heading_deg;
  };
  for (const auto& [name, heading_deg] :
       {View{"left", 40}, View{"middle", 0}, View{"right", -40}}) {
    const double limit_mm = lamp.search_limit_mm(heading_deg * kRadPerDegree);
    results.value("search_limits", std::string{name} + " limit", limit_mm);
    const Vector3d direction{std::cos(heading_deg * kRadPerDegree),
                             std::sin(heading_deg * kRadPerDegree), 0};
    const JointVector q =
        lamp.joints(Vector3d{1e-3 * limit_mm, 0, 0.50407} + 0.08 * direction, direction);
    std::vector<Eigen::Isometry3d> frames(lamp.model().joints().size());
    joint_frames(lamp.model(), q, frames);
    std::vector<double> x{0}, y{0};
    for (const Eigen::Isometry3d& frame : frames) {
      x.push_back(1e3 * frame.translation().x());
      y.push_back(1e3 * frame.translation().y());
    }
    results.curve("figures_15_17", 0, std::string{name} + " view", x, y);
  }
}

/// Figures 22 to 24.
void add_motion(const LampExample& lamp, const Trajectory& plan, Results& results) {
  constexpr int kSamples = 300;
  std::vector<double> time;
  std::array<std::vector<double>, 6> q, v, a;
  for (int n = 0; n <= kSamples; ++n) {
    const double t = 3.0 * n / kSamples;
    const JointState state = plan.at(plan.start + seconds(t));
    time.push_back(t);
    for (int i = 0; i < 6; ++i) {
      const auto joint = static_cast<std::size_t>(i);
      q[joint].push_back(lamp.all_joints(state.q)[i]);
      v[joint].push_back(lamp.all_joints(state.v)[i]);
      a[joint].push_back(lamp.all_joints(state.a)[i]);
    }
  }
  for (int i = 0; i < 6; ++i) {
    const auto joint = static_cast<std::size_t>(i);
    results.curve("figure_22", 0, theta(i), time, q[joint]);
    results.curve("figure_23", 0, theta(i), time, v[joint]);
    results.curve("figure_24", 0, theta(i), time, a[joint]);
  }
}

/// The paper's two moves from P1 to P3 beside the arc in the same time.
void add_comparison(LampExample& lamp, const Trajectory& plan, Results& results) {
  constexpr int kSamples = 200;
  const std::vector<ToolPose> points = lamp.mouth_points();
  const Trajectory arc =
      lamp.timed("trajectory/quintic_spline", {lamp.arc_segment(points.front(), points.back(), 2)});
  std::vector<double> time;
  std::array<std::vector<double>, 2> distance, aim;
  for (int n = 0; n <= kSamples; ++n) {
    const double t = 2.0 * n / kSamples;
    time.push_back(1 + t);
    const std::array standings{lamp.standing_at(plan.at(plan.start + seconds(1 + t)).q),
                               lamp.standing_at(arc.at(arc.start + seconds(t)).q)};
    for (std::size_t k = 0; k < 2; ++k) {
      distance[k].push_back(standings[k].distance_mm);
      aim[k].push_back(standings[k].aim_deg);
    }
  }
  for (std::size_t k = 0; k < 2; ++k) {
    const char* name = k == 0 ? "the paper's plan" : "path/mouth_arc";
    results.curve("tables_2_3", 0, name, time, distance[k]);
    results.curve("tables_2_3", 1, name, time, aim[k]);
  }
}

/// A feature in the paper's frame 7 [mm]: x depth, y up, z right, in the middle between both
/// cameras.
Vector3d seen(const Numbers& numbers, const char* feature) {
  const Numbers camera = numbers["camera"], pixels = numbers["pixels"][feature];
  const Eigen::VectorXd centre = camera["center_px"].numbers();
  const StereoCamera stereo{.width = static_cast<int>(camera["width"].number()),
                            .height = static_cast<int>(camera["height"].number()),
                            .focal_px = camera["focal_px"].number(),
                            .cx = centre[0],
                            .cy = centre[1],
                            .baseline_m = 1e-3 * camera["baseline_mm"].number()};
  const Vector3d left =
      stereo.triangulate(pixels["left"].numbers().head<2>(), pixels["right"].numbers().head<2>());
  return 1e3 * Vector3d{left.z(), -left.y(), left.x() - 0.5 * stereo.baseline_m};
}

void add_simulation(const Numbers& numbers, LampExample& lamp, Results& results) {
  const std::string table = "section_5";
  const Vector3d left_eye = seen(numbers, "left_eye"), right_eye = seen(numbers, "right_eye"),
                 seen_mouth = seen(numbers, "mouth");
  results.point(table, "mouth", seen_mouth);
  results.value(table, "eyes.x", left_eye.x());
  results.value(table, "left eye.y", left_eye.y());
  results.value(table, "left eye.z", left_eye.z());
  results.value(table, "right eye.y", right_eye.y());
  results.value(table, "right eye.z", right_eye.z());
  results.point(table, "face normal",
                (right_eye - seen_mouth).cross(left_eye - seen_mouth).normalized());
  const Numbers test = numbers["simulation"];
  const JointVector start =
      lamp.model().to_independent(kRadPerDegree * test["start_deg"].numbers()).value();
  results.point(table, "lamp at the start",
                1e3 * forward_kinematics(lamp.model(), start).translation());
  const Vector3d mouth = test["mouth"].numbers(), lamp_at = test["lamp"].numbers();
  const Vector3d measured = test["mouth_measured"].numbers();
  const Vector3d turns = kRadPerDegree * Vector3d{test["photo_deg"].numbers()};
  const Eigen::Matrix3d photo = (Eigen::AngleAxisd{turns[0], Vector3d::UnitX()} *
                                 Eigen::AngleAxisd{turns[1], Vector3d::UnitY()} *
                                 Eigen::AngleAxisd{turns[2], Vector3d::UnitZ()})
                                    .toRotationMatrix();
  results.value(table, "photo normal.z", photo(2, 2));
  results.value(table, "sphere distance", (mouth - lamp_at).norm());
  results.point(table, "mouth error", measured - mouth);
  results.value(table, "mouth error", (measured - mouth).norm());
  results.value(table, "normal deviation",
                angle_between(test["normal_measured"].numbers().head<3>(),
                              test["normal"].numbers().head<3>()) /
                    kRadPerDegree);
  const JointVector goal =
      lamp.all_joints(lamp.joints(1e-3 * lamp_at, (mouth - lamp_at).normalized()));
  for (int i = 0; i < 6; ++i) results.value(table, "goal " + theta(i), goal[i]);
}

/// Section 5 as a deployment: what the lamp sees and how far off it is, at rest at the end.
void add_experiment(Results& results) {
  const auto report = run_experiment("lamp_section_5");
  const std::vector<double> error = report.at("mouth_error_mm");
  results.point("experiment", "mouth error", {error.at(0), error.at(1), error.at(2)});
  results.value("experiment", "mouth error", report.at("mouth_position_error_mm"));
  results.value("experiment", "normal error", report.at("face_normal_error_deg"));
  results.value("experiment", "distance error", report.at("distance_error_mm"));
  results.value("experiment", "direction error", report.at("direction_error_deg"));
  // u and v in the left picture, then in the right one.
  const std::vector<double> left_eye = report.at("left_eye_px"),
                            right_eye = report.at("right_eye_px"), mouth = report.at("mouth_px");
  constexpr std::array kCoordinates{"u, left", "v, left", "u, right", "v, right"};
  for (std::size_t i = 0; i < kCoordinates.size(); ++i) {
    results.value("experiment_pixels", std::string{"mouth "} + kCoordinates[i], mouth.at(i));
  }
  results.value("experiment_pixels", "eyes apart, left", right_eye.at(0) - left_eye.at(0));
  results.value("experiment_pixels", "eyes apart, right", right_eye.at(2) - left_eye.at(2));
}

}  // namespace

void compute_lamp(const Numbers& numbers, bool with_long, Results& results) {
  LampExample lamp{numbers, shipped_robot("dental_lamp")};
  const Trajectory plan = lamp.paper_plan();
  add_inverse(numbers, lamp, results);
  add_points(numbers, lamp, results);
  add_quintics(plan, results);
  add_errors(lamp, plan, results);
  add_search(lamp, results);
  add_motion(lamp, plan, results);
  add_comparison(lamp, plan, results);
  add_simulation(numbers, lamp, results);
  if (!with_long) return;
  add_experiment(results);
  add_detection(results);
}

}  // namespace armature::reproduce
