// SPDX-License-Identifier: Apache-2.0
// Zhong et al. 2023: curves through many orientations.
#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <limits>
#include <random>

#include "armature/robot/geometry/rotation_vector.hpp"
#include "armature/robot/orientations/corner_blend.hpp"
#include "armature/robot/orientations/curve_measures.hpp"
#include "bench/random_joints.hpp"
#include "reproduce/implant_arm.hpp"
#include "reproduce/papers.hpp"
#include "reproduce/plugins.hpp"

namespace armature::reproduce {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

struct Interpolator {
  const char* name;
  OrientationInterpolator kind;
};
constexpr std::array kInterpolators{
    Interpolator{"slerp", OrientationInterpolator::slerp},
    Interpolator{"squad", OrientationInterpolator::squad},
    Interpolator{"rotvec_bspline", OrientationInterpolator::rotvec_bspline},
    Interpolator{"chart_bspline", OrientationInterpolator::chart_bspline}};

/// At even parameters for SQUAD, as Shoemake has it; the others at one common speed.
OrientationCurve curve_of(const Keys& keys, OrientationInterpolator kind) {
  std::vector<double> even;
  if (kind == OrientationInterpolator::squad) {
    for (std::size_t i = 0; i < keys.size(); ++i) {
      even.push_back(static_cast<double>(i) / static_cast<double>(keys.size() - 1));
    }
  }
  return or_throw(OrientationCurve::through(keys, kind, even), "keys");
}

Keys table3_keys(const Numbers& numbers) {
  Keys keys;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::VectorXd wxyz = numbers["quaternions"][i].numbers(4);
    keys.push_back(Quaterniond{wxyz[0], wxyz[1], wxyz[2], wxyz[3]}.normalized());
  }
  return keys;
}

/// The keys, the control points between them, and what each curve turns by.
void add_table3(const Keys& keys, Results& results) {
  const std::string table = "table_3";
  std::vector<Vector3d> P;
  for (const Quaterniond& key : keys) P.push_back(rotation_vector_of(key));
  for (std::size_t i = 0; i < 3; ++i) results.point(table, std::string{"P_"} + "ABC"[i], P[i]);
  const double l0 = 0.5 * std::min((P[0] - P[1]).norm(), (P[2] - P[1]).norm());
  const Vector3d D = P[1] + l0 * (P[0] - P[1]).normalized();
  const Vector3d E = P[1] + l0 * (P[2] - P[1]).normalized();
  const CornerControls controls = corner_controls(D, P[1], E, D - P[0], P[2] - E);
  for (std::size_t i = 0; i < controls.size(); ++i) {
    results.point(table, "d" + std::to_string(i), controls[i]);
  }
  for (const auto& [name, kind] : kInterpolators) {
    results.value(table, std::string{"total rotation, "} + name,
                  total_rotation(curve_of(keys, kind)));
  }
  // From a millionth of a piece away what is continuous has no jump, and what is not has all of it.
  for (const auto& [name, kind] : kInterpolators) {
    const OrientationJump jump = largest_jump_beside(curve_of(keys, kind), 1e-6);
    results.value("continuity", std::string{name} + ", jump of the velocity", jump.velocity);
    results.value("continuity", std::string{name} + ", jump of the acceleration",
                  jump.acceleration);
  }
  const OrientationPeaks peaks = peaks_of(curve_of(keys, OrientationInterpolator::rotvec_bspline));
  // The paper counts a piece as 1, and there are three.
  results.value(table, "peak velocity, rotvec_bspline", peaks.velocity / 3);
}

Keys random_keys(std::mt19937_64& random, std::size_t count) {
  Keys keys(count);
  for (Quaterniond& key : keys) key = bench::any_rotation(random);
  return keys;
}

/// Total rotations of curves through so many keys at random, as multiples of SLERP's; of few keys
/// the mean of many curves.
void add_table5(Results& results) {
  struct Size {
    std::size_t keys;
    int curves;
  };
  constexpr int kPartsOfAPiece = 40;
  for (const auto& [count, curves] : {Size{3, 2000}, Size{100, 40}, Size{1000, 4}}) {
    std::mt19937_64 random{count};
    std::array<double, kInterpolators.size()> total{};
    for (int i = 0; i < curves; ++i) {
      const Keys keys = random_keys(random, count);
      for (std::size_t k = 0; k < kInterpolators.size(); ++k) {
        total[k] += total_rotation(curve_of(keys, kInterpolators[k].kind), kPartsOfAPiece);
      }
    }
    const std::string size = std::to_string(count) + " keys, ";
    results.value("table_5", size + "slerp, of an arc",
                  total[0] / curves / static_cast<double>(count - 1));
    for (std::size_t k = 1; k < kInterpolators.size(); ++k) {
      results.value("table_5", size + kInterpolators[k].name + " of slerp", total[k] / total[0]);
    }
  }
}

/// [s] of this thread's processor time.
double processor_time_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// [s] to build a curve and to take a thousand samples of each of its arcs.
double seconds_for(const Keys& keys, OrientationInterpolator kind) {
  volatile double kept = 0;  // so that no sample can be left out
  const std::vector<double> places = parameters_along(curve_of(keys, kind), 1000);
  const double start_s = processor_time_s();
  const OrientationCurve curve = curve_of(keys, kind);
  double sum = 0;
  for (const double u : places) {
    sum += curve.at(u, Rates::velocity).rotation.w();
  }
  kept = sum;
  const double passed_s = processor_time_s() - start_s;
  static_cast<void>(kept);
  return passed_s / static_cast<double>(curve.piece_starts().size());
}

/// Computing times as multiples of SLERP's, for a sample of each: the least of fifteen. They take
/// turns, so that what else the machine does meets all of them.
void add_table4(Results& results) {
  constexpr std::array kKinds{OrientationInterpolator::slerp, OrientationInterpolator::squad,
                              OrientationInterpolator::rotvec_bspline};
  std::mt19937_64 random{4};
  for (const std::size_t count : {std::size_t{3}, std::size_t{50}, std::size_t{100}}) {
    const Keys keys = random_keys(random, count);
    std::array<double, kKinds.size()> least;
    least.fill(std::numeric_limits<double>::infinity());
    for (int repetition = 0; repetition < 15; ++repetition) {
      for (std::size_t k = 0; k < kKinds.size(); ++k) {
        least[k] = std::min(least[k], seconds_for(keys, kKinds[k]));
      }
    }
    const std::string size = std::to_string(count) + " keys, ";
    results.value("table_4", size + "squad of slerp", least[1] / least[0]);
    results.value("table_4", size + "rotvec_bspline of slerp", least[2] / least[0]);
  }
}

/// Where a rotation takes z: the map of Hopf from quaternions to the sphere.
Vector3d hopf(const Quaterniond& q) { return q * Vector3d::UnitZ(); }

Vector3d euler_zyx_deg(const Quaterniond& q) {
  const Eigen::Matrix3d R = q.toRotationMatrix();
  return 180 / M_PI *
         Vector3d{std::atan2(R(1, 0), R(0, 0)), -std::asin(std::clamp(R(2, 0), -1.0, 1.0)),
                  std::atan2(R(2, 1), R(2, 2))};
}

/// Figures 4 to 7.
void add_figures(const Keys& keys, Results& results) {
  constexpr int kSamples = 300;
  std::vector<double> x, y, z;
  for (const Quaterniond& key : keys) {
    x.push_back(hopf(key).x());
    y.push_back(hopf(key).y());
    z.push_back(hopf(key).z());
  }
  results.curve("figure_4", 0, "keys", x, y, Results::Look::dots);
  results.curve("figure_4", 1, "keys", x, z, Results::Look::dots);
  constexpr std::array kFigures{"figure_5", "figure_6", "figure_7"};
  for (std::size_t k = 0; k < kFigures.size(); ++k) {
    const OrientationCurve curve = curve_of(keys, kInterpolators[k].kind);
    std::vector<double> u;
    std::array<std::vector<double>, 3> place, angle, velocity, acceleration;
    for (int i = 0; i <= kSamples; ++i) {
      u.push_back(static_cast<double>(i) / kSamples);
      const OrientationState state = curve.at(u.back());
      const Vector3d at = hopf(state.rotation), euler = euler_zyx_deg(state.rotation);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto j = static_cast<Eigen::Index>(axis);
        place[axis].push_back(at[j]);
        angle[axis].push_back(euler[j]);
        velocity[axis].push_back(state.velocity[j]);
        acceleration[axis].push_back(state.acceleration[j]);
      }
    }
    results.curve("figure_4", 0, kInterpolators[k].name, place[0], place[1]);
    results.curve("figure_4", 1, kInterpolators[k].name, place[0], place[2]);
    constexpr std::array kAngles{"z", "y", "x"};
    constexpr std::array kAxes{"x", "y", "z"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      results.curve(kFigures[k], 0, kAngles[axis], u, angle[axis]);
      results.curve(kFigures[k], 1, kAxes[axis], u, velocity[axis]);
      results.curve(kFigures[k], 2, kAxes[axis], u, acceleration[axis]);
    }
  }
}

}  // namespace

void compute_implant(const Numbers& numbers, bool with_long, Results& results) {
  const Keys keys = table3_keys(numbers);
  add_table3(keys, results);
  add_figures(keys, results);
  add_turning_arm(keys, results);
  if (!with_long) return;
  add_table4(results);
  add_table5(results);
}

}  // namespace armature::reproduce
