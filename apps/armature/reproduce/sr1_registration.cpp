// SPDX-License-Identifier: Apache-2.0
// SR-1, how the head in the images lies before the robot: all registrations on the same markers,
// on one case, as predicted to first order and simulated.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "armature/kinds/registration/registration.hpp"
#include "armature/kinds/registration/target_error.hpp"
#include "reproduce/plugins.hpp"
#include "reproduce/sr1_parts.hpp"

namespace armature::reproduce::sr1 {
namespace {

using Eigen::Vector3d;

enum class Kind { affine, frame, least_squares };
struct Method {
  Kind kind;
  const char* name;
  const char* id;
  std::size_t markers;  // the first ones of the head
};
constexpr std::array kMethods{
    Method{Kind::affine, "affine, 4 markers", "registration/affine4", 4},
    Method{Kind::frame, "frame, 3 markers", "registration/frame3", 3},
    Method{Kind::least_squares, "least squares, 3 markers", "registration/rigid", 3},
    Method{Kind::least_squares, "least squares, 4 markers", "registration/rigid", 4},
    Method{Kind::least_squares, "least squares, 6 markers", "registration/rigid", 6},
};

std::vector<Vector3d> points_m(const Numbers& points_mm) {
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i < points_mm.size(); ++i) points.push_back(points_mm[i].point_m());
  return points;
}

double rms(const std::vector<double>& values) {
  double squares = 0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

/// The value that 95 of 100 are below.
double quantile95(std::vector<double> values) {
  const auto place =
      values.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(values.size()));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

double correlation(const std::vector<double>& x, const std::vector<double>& y) {
  using Values = Eigen::Map<const Eigen::VectorXd>;
  const Values a{x.data(), static_cast<Eigen::Index>(x.size())},
      b{y.data(), static_cast<Eigen::Index>(y.size())};
  const Eigen::VectorXd from_a = a.array() - a.mean(), from_b = b.array() - b.mean();
  return from_a.normalized().dot(from_b.normalized());
}

/// Registrations of markers with noise.
struct Trials {
  std::vector<std::vector<double>> tre_mm;  // of each target, in every trial
  std::vector<double> fre_mm;
};

class Head {
 public:
  explicit Head(const Numbers& numbers)
      : image_{points_m(numbers["image_markers_mm"])},
        exact_{points_m(numbers["robot_markers_mm"])},
        noisy_{points_m(numbers["robot_markers_noisy_mm"])},
        target_{numbers["target_mm"].point_m()},
        marker_error_m_{1e-3 * numbers["marker_error_mm"].number()} {}

  double marker_error_m() const { return marker_error_m_; }
  const Vector3d& target() const { return target_; }

  const Registrar& registrar(const Method& method) {
    return plugins_.get<Registrar>(method.id, "");
  }
  MarkerPairs exact(const Method& method) const { return first(method.markers, exact_); }
  MarkerPairs noisy(const Method& method) const { return first(method.markers, noisy_); }

  PointError predicted(const Method& method, const Vector3d& target, double marker_error_m) {
    return predicted_error(registrar(method), exact(method), target, marker_error_m).value();
  }

  /// Of the same seed always the same: no result depends on which ones were computed before.
  Trials simulated(const Method& method, const std::vector<Vector3d>& targets,
                   double marker_error_m, int count, std::uint64_t seed) {
    std::mt19937_64 random{seed};
    std::normal_distribution<double> noise{0, marker_error_m / std::sqrt(3.0)};
    const MarkerPairs markers = exact(method);
    const Registration truth = registrar(method).find(markers).value();
    Trials trials{.tre_mm = std::vector<std::vector<double>>(targets.size())};
    for (int n = 0; n < count; ++n) {
      MarkerPairs measured = markers;
      for (Vector3d& marker : measured.robot) {
        for (double& coordinate : marker) coordinate += noise(random);
      }
      const Registration found = registrar(method).find(measured).value();
      for (std::size_t i = 0; i < targets.size(); ++i) {
        const Vector3d off = found.robot_T_image * targets[i] - truth.robot_T_image * targets[i];
        trials.tre_mm[i].push_back(1e3 * off.norm());
      }
      trials.fre_mm.push_back(1e3 * found.fre_m);
    }
    return trials;
  }

 private:
  MarkerPairs first(std::size_t count, const std::vector<Vector3d>& robot) const {
    MarkerPairs pairs{image_, robot};
    pairs.image.resize(count);
    pairs.robot.resize(count);
    return pairs;
  }

  std::vector<Vector3d> image_, exact_, noisy_;
  Vector3d target_;
  double marker_error_m_;
  Plugins plugins_;
};

/// The markers of the case, exact and with their errors.
void add_case(Head& head, Results& results) {
  constexpr std::array kPlaces{"x", "y", "z"};
  for (const Method& method : kMethods) {
    const std::string row = std::string{method.name} + ": ";
    const Registrar& registrar = head.registrar(method);
    const Registration found = registrar.find(head.noisy(method)).value();
    const Vector3d at = found.robot_T_image * head.target();
    for (int i = 0; i < 3; ++i) {
      results.value("registration_case", row + "target " + kPlaces[static_cast<std::size_t>(i)],
                    1e3 * at[i]);
    }
    results.value("registration_case", row + "FRE", 1e3 * found.fre_m);
    const Vector3d exact = registrar.find(head.exact(method)).value().robot_T_image * head.target();
    for (int i = 0; i < 3; ++i) {
      results.value("registration_exact", row + "target " + kPlaces[static_cast<std::size_t>(i)],
                    1e3 * exact[i]);
    }
    if (method.kind == Kind::affine) {
      results.value("registration_case", row + "condition of E", found.condition);
    }
  }
}

void add_predicted(Head& head, const Vector3d& deep, Results& results) {
  for (const Method& method : kMethods) {
    const std::string row = std::string{method.name} + ": ";
    const PointError error = head.predicted(method, head.target(), head.marker_error_m());
    results.value("registration_predicted", row + "TRE rms", 1e3 * error.rms_m);
    results.value("registration_predicted", row + "TRE of 95 %", 1e3 * error.bound95_m);
    results.value("registration_deep", row + "predicted",
                  1e3 * head.predicted(method, deep, head.marker_error_m()).rms_m);
  }
}

void add_simulated(Head& head, const Vector3d& deep, int trials, Results& results) {
  for (const Method& method : kMethods) {
    const std::string row = std::string{method.name} + ": ", table = "registration_simulated";
    const Trials got =
        head.simulated(method, {head.target(), deep}, head.marker_error_m(), trials, 2005);
    results.value(table, row + "TRE rms", rms(got.tre_mm[0]));
    results.value(table, row + "TRE of 95 %", quantile95(got.tre_mm[0]));
    results.value(table, row + "deep TRE rms", rms(got.tre_mm[1]));
    if (method.kind == Kind::frame) continue;
    results.value(table, row + "FRE rms", rms(got.fre_mm));
    if (method.kind == Kind::affine) continue;
    results.value(table, row + "correlation of FRE and TRE",
                  correlation(got.fre_mm, got.tre_mm[0]));
  }
}

constexpr int kDots = 10;

/// The marker error of the `n`-th dot [m].
double marker_error_m_at(int n) { return 1e-4 * n; }
/// The depth of the `n`-th dot below the origin of the images, the centre of the head [m].
double depth_m_at(int n) { return 0.01 * n; }

void add_lines(Head& head, Results& results) {
  for (const Method& method : kMethods) {
    std::vector<double> noise_mm, over_noise, depth_mm, over_depth;
    for (int n = 0; n <= kDots; ++n) {
      const double noise_m = marker_error_m_at(n), depth_m = depth_m_at(n);
      noise_mm.push_back(1e3 * noise_m);
      over_noise.push_back(1e3 * head.predicted(method, head.target(), noise_m).rms_m);
      depth_mm.push_back(1e3 * depth_m);
      over_depth.push_back(1e3 *
                           head.predicted(method, {0, 0, -depth_m}, head.marker_error_m()).rms_m);
    }
    results.curve("tre_over_noise", 0, method.name, noise_mm, over_noise);
    results.curve("tre_over_depth", 0, method.name, depth_mm, over_depth);
  }
}

void add_dots(Head& head, Results& results) {
  constexpr int kTrials = 1000;
  std::vector<double> noise_mm, over_noise, depth_mm, over_depth;
  for (const Method& method : kMethods) {
    for (int n = 1; n <= kDots; ++n) {
      const auto seed = static_cast<std::uint64_t>(n);
      const double noise_m = marker_error_m_at(n), depth_m = depth_m_at(n);
      noise_mm.push_back(1e3 * noise_m);
      over_noise.push_back(
          rms(head.simulated(method, {head.target()}, noise_m, kTrials, seed).tre_mm.front()));
      depth_mm.push_back(1e3 * depth_m);
      over_depth.push_back(
          rms(head.simulated(method, {{0, 0, -depth_m}}, head.marker_error_m(), kTrials, seed)
                  .tre_mm.front()));
    }
  }
  const char* name = "simulated, 1000 trials each";
  results.curve("tre_over_noise", 0, name, noise_mm, over_noise, Results::Look::dots);
  results.curve("tre_over_depth", 0, name, depth_mm, over_depth, Results::Look::dots);
}

}  // namespace

void add_registrations(const Numbers& numbers, bool with_long, Results& results) {
  const Numbers registration = numbers["registration"];
  Head head{registration};
  const Vector3d deep = registration["deep_target_mm"].point_m();
  add_case(head, results);
  add_predicted(head, deep, results);
  if (with_long) {
    add_simulated(head, deep, static_cast<int>(registration["trials"].number()), results);
  }
  add_lines(head, results);
  add_dots(head, results);
}

}  // namespace armature::reproduce::sr1
