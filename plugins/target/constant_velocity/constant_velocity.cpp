// SPDX-License-Identifier: Apache-2.0
#include "constant_velocity.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "armature/runtime/plugins/plugin.hpp"
#include "measurement_noise.hpp"
#include "outliers.hpp"
#include "scatter.hpp"

namespace armature::target::constant_velocity {
namespace {

// The state: position, velocity, normal, rate of the normal; three numbers each.
enum Block { kPosition = 0, kVelocity = 3, kNormal = 6, kNormalRate = 9 };
using Vector12 = Eigen::Matrix<double, 12, 1>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix12 = Eigen::Matrix<double, 12, 12>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Matrix12x6 = Eigen::Matrix<double, 12, 6>;

constexpr double kDegreesOfFreedom = 5;  // of a measurement: a point and a direction
constexpr double kDegreesPerRadian = 180 / std::numbers::pi;
constexpr double kSmoothing = 0.4;        // weight of the newest innovation
constexpr double kSettledSurprise = 1.5;  // moving -> still, and
constexpr double kSettledRates = 1.3;     // normalised square of the rates: 1 for a still target
constexpr double kMaxVariance = 1e6;      // [m2], [rad2]: such a measurement says nothing
constexpr int kPossible = 2;              // outliers that agree, where the target can have gone

// What is added to the covariances of a measurement, [m2] and [rad2]: (0.02 mm)^2 and (0.2 mrad)^2,
// less than any camera errs. Covariances of zero would make motion of all noise.
constexpr double kAddedPosition = 4e-10, kAddedNormal = 4e-8;

constexpr double kMaxBack = 0.1;  // [s] by which a prediction may be before the newest measurement

/// Over dt, positions go on with their rates; `decay` is what is left of a rate.
void carry_on(Vector12& mean, double dt, double decay) {
  for (const int block : {kPosition, kNormal}) {
    mean.segment<3>(block) += dt * mean.segment<3>(block + 3);
    mean.segment<3>(block + 3) *= decay;
  }
}
/// The same of the covariance: F P F'.
void carry_on(Matrix12& covariance, double dt, double decay) {
  for (const int block : {kPosition, kNormal}) {
    covariance.middleRows<3>(block) += dt * covariance.middleRows<3>(block + 3);
    covariance.middleRows<3>(block + 3) *= decay;
  }
  for (const int block : {kPosition, kNormal}) {
    covariance.middleCols<3>(block) += dt * covariance.middleCols<3>(block + 3);
    covariance.middleCols<3>(block + 3) *= decay;
  }
}

/// Variances that a rate of variance `rate`, constant over dt, and an acceleration that is white
/// noise and changes the rate over dt as one of variance `acceleration` would, add to one block
/// (Bar-Shalom et al. 2001, section 6.2.2). An acceleration that is constant over dt would be of
/// rank one: with good measurements that are far apart, the rate then swings from one to the next.
void add_process_noise(Matrix12& covariance, int block, double dt, double rate,
                       double acceleration) {
  const double dt2 = dt * dt;
  covariance.block<3, 3>(block, block).diagonal().array() += acceleration * dt2 * dt2 / 3;
  covariance.block<3, 3>(block, block + 3).diagonal().array() += 0.5 * acceleration * dt2 * dt;
  covariance.block<3, 3>(block + 3, block).diagonal().array() += 0.5 * acceleration * dt2 * dt;
  covariance.block<3, 3>(block + 3, block + 3).diagonal().array() += acceleration * dt2 + rate;
}

bool is_sound(const TargetMeasurement& m) {
  const Matrix6 noise = measurement_noise(m);
  return m.position.allFinite() && m.normal.allFinite() && m.normal.norm() >= 0.5 &&
         noise.allFinite() && noise.trace() < kMaxVariance && noise.llt().info() == Eigen::Success;
}

TargetMeasurement with_least_noise(TargetMeasurement measurement) {
  measurement.position_covariance.diagonal().array() += kAddedPosition;
  measurement.normal_covariance.diagonal().array() += kAddedNormal;
  return measurement;
}

/// Rows and columns of what is measured.
Matrix12x6 measured_columns(const Matrix12& p) {
  Matrix12x6 columns;
  columns << p.middleCols<3>(kPosition), p.middleCols<3>(kNormal);
  return columns;
}
Matrix6 measured_block(const Matrix12x6& columns) {
  Matrix6 block;
  block << columns.middleRows<3>(kPosition), columns.middleRows<3>(kNormal);
  return block;
}

struct Innovation {
  Vector6 value;
  Matrix12x6 gain_numerator;  // P H'
  Eigen::LLT<Matrix6> covariance;
  double normalised;  // value' S^-1 value
};

Innovation innovation(const TargetMeasurement& m, const Vector12& mean,
                      const Matrix12& covariance) {
  Innovation result;
  result.value << m.position - mean.segment<3>(kPosition), m.normal - mean.segment<3>(kNormal);
  result.gain_numerator = measured_columns(covariance);
  const Matrix6 s = measured_block(result.gain_numerator) + measurement_noise(m);
  result.covariance.compute(s);
  result.normalised = result.value.dot(result.covariance.solve(result.value));
  return result;
}

/// Are the rates larger than their uncertainty explains?
bool has_rates(const Vector12& mean, const Matrix12& covariance) {
  Vector6 rates;
  rates << mean.segment<3>(kVelocity), mean.segment<3>(kNormalRate);
  Vector6 variances;
  variances << covariance.diagonal().segment<3>(kVelocity),
      covariance.diagonal().segment<3>(kNormalRate);
  return rates.cwiseAbs2().cwiseQuotient(variances).mean() > kSettledRates;
}

TargetEstimate estimate_of(Time stamp, int measurements, const Vector12& mean) {
  const Eigen::Vector3d normal = mean.segment<3>(kNormal).normalized();
  const Eigen::Vector3d rate = mean.segment<3>(kNormalRate);
  return {.stamp = stamp,
          .position = mean.segment<3>(kPosition),
          .normal = normal,
          .velocity = mean.segment<3>(kVelocity),
          .normal_rate = rate - normal * normal.dot(rate),
          .measurements = measurements};
}

/// What is remembered, as plain numbers.
struct Memory {
  static constexpr auto kLayout = layout_id("target/constant_velocity", 2);
  Time stamp;
  int measurements;
  Outliers outliers;
  Scatter scatter;
  double nis;
  bool moving;
  std::array<double, 12> mean;
  std::array<double, 144> covariance;
};

}  // namespace

/// What the filter believes of the target.
struct ConstantVelocity::Belief {
  Time stamp;
  int measurements = 1;
  Outliers outliers{};
  Scatter scatter{};
  double nis = 1;  // smoothed normalised innovation: about 1 while the model holds
  bool moving = false;
  Vector12 mean = Vector12::Zero();
  Matrix12 covariance = Matrix12::Zero();

  static std::optional<Belief> in(const PluginState& state) {
    const Memory* m = state.get<Memory>();
    if (!m) return std::nullopt;
    return Belief{m->stamp,
                  m->measurements,
                  m->outliers,
                  m->scatter,
                  m->nis,
                  m->moving,
                  Eigen::Map<const Vector12>{m->mean.data()},
                  Eigen::Map<const Matrix12>{m->covariance.data()}};
  }
  void keep_in(PluginState& state) const {
    Memory m{.stamp = stamp,
             .measurements = measurements,
             .outliers = outliers,
             .scatter = scatter,
             .nis = nis,
             .moving = moving,
             .covariance = {}};
    Eigen::Map<Vector12>{m.mean.data()} = mean;
    Eigen::Map<Matrix12>{m.covariance.data()} = covariance;
    state.set(m);
  }
};

Expected<std::unique_ptr<TargetFilter>> ConstantVelocity::make(const Params& params) {
  return std::make_unique<ConstantVelocity>(Parameters::read(params));
}

ConstantVelocity::Belief ConstantVelocity::started_at(const TargetMeasurement& measurement) const {
  Belief belief{.stamp = measurement.stamp};
  belief.scatter.add(measurement);
  belief.mean.segment<3>(kPosition) = measurement.position;
  belief.mean.segment<3>(kNormal) = measurement.normal;
  const Matrix6 r = measurement_noise(measurement);
  const auto variance = [](double x) { return x * x * Eigen::Matrix3d::Identity(); };
  belief.covariance.block<3, 3>(kPosition, kPosition) = r.topLeftCorner<3, 3>();
  belief.covariance.block<3, 3>(kVelocity, kVelocity) = variance(parameters_.still_speed);
  belief.covariance.block<3, 3>(kNormal, kNormal) = r.bottomRightCorner<3, 3>();
  belief.covariance.block<3, 3>(kNormalRate, kNormalRate) = variance(parameters_.still_turn);
  return belief;
}

void ConstantVelocity::advance(Belief& belief, double dt_s, bool moving) const {
  const double decay = moving ? 1.0 : std::exp(-dt_s / parameters_.decay);
  carry_on(belief.mean, dt_s, decay);
  carry_on(belief.covariance, dt_s, decay);
  const auto noise = [&](int block, double still, double acceleration) {
    // What decays comes back as noise, so that a still target's rates keep their variance.
    const double rate = moving ? 0 : still * still * (1 - decay * decay);
    add_process_noise(belief.covariance, block, dt_s, rate,
                      moving ? acceleration * acceleration : 0);
  };
  noise(kPosition, parameters_.still_speed, parameters_.acceleration);
  noise(kNormal, parameters_.still_turn, parameters_.turn_acceleration);
  belief.stamp = belief.stamp + seconds(dt_s);
}

Expected<TargetEstimate> ConstantVelocity::update(const TargetMeasurement& told,
                                                  PluginState& state) const {
  if (!is_sound(told)) {
    return refuse(
        "the measurement is not finite, its normal is no unit vector, or a covariance is none");
  }
  const TargetMeasurement measurement = with_least_noise(told);
  std::optional<Belief> belief = Belief::in(state);
  if (!belief || to_seconds(measurement.stamp - belief->stamp) > parameters_.max_gap) {
    belief = started_at(measurement);
    belief->keep_in(state);
    return estimate_of(belief->stamp, belief->measurements, belief->mean);
  }
  const Expected<Belief> next = updated(measurement, *belief);
  (next ? *next : *belief).keep_in(state);
  return next.map([](const Belief& b) { return estimate_of(b.stamp, b.measurements, b.mean); });
}

struct ConstantVelocity::Outlier {
  std::string why;
  bool is_possible;  // the target can have gone there since the newest measurement
};

std::optional<ConstantVelocity::Outlier> ConstantVelocity::outlier(
    const TargetMeasurement& measurement, const Belief& belief, const Belief& predicted) const {
  const double dt_s = to_seconds(predicted.stamp - belief.stamp);
  const Deviation is = deviation(measurement.position - predicted.mean.segment<3>(kPosition),
                                 measurement.normal - predicted.mean.segment<3>(kNormal));
  const auto known = [&](int block) -> Eigen::Matrix3d {
    return belief.covariance.block<3, 3>(block, block);
  };
  const auto widest_after = [&](double time_s) {
    return widest_deviation(time_s, known(kPosition) + measurement.position_covariance,
                            known(kNormal) + measurement.normal_covariance, parameters_);
  };
  const Deviation alone = widest_after(std::min(dt_s, kBelievedAlone));
  if (is.is_within(alone)) return std::nullopt;
  return Outlier{
      fmt::format("outlier: {:.0f} mm and {:.0f} degrees from where the target should be; a "
                  "measurement alone is believed within {:.0f} mm and {:.0f} degrees",
                  is.distance_m * 1e3, is.angle_rad * kDegreesPerRadian, alone.distance_m * 1e3,
                  alone.angle_rad * kDegreesPerRadian),
      is.is_within(widest_after(dt_s))};
}

/// The next belief, or why the measurement was rejected, which `belief` counts.
Expected<ConstantVelocity::Belief> ConstantVelocity::updated(const TargetMeasurement& told,
                                                             Belief& belief) const {
  const double dt = to_seconds(told.stamp - belief.stamp);
  if (dt <= 0) {
    return refuse(
        fmt::format("the measurement is {:.1f} ms older than the newest one", std::abs(dt) * 1e3));
  }

  const TargetMeasurement measurement = belief.scatter.explained(told);
  Belief still = belief, moving = belief;
  advance(still, dt, false);
  advance(moving, dt, true);
  const auto innovation_of = [&](const Belief& b) {
    return innovation(measurement, b.mean, b.covariance);
  };
  if (const auto off = outlier(measurement, belief, moving)) {
    // An estimate is worth as many outliers as it has measurements, at most restart_after.
    const int most = off->is_possible ? std::min(kPossible, parameters_.restart_after)
                                      : parameters_.restart_after;
    const int enough = std::min(most, belief.measurements);
    if (belief.outliers.count_with(measurement, parameters_) < enough) return refuse(off->why);
    return started_at(measurement);
  }

  const double nis = innovation_of(still).normalised / kDegreesOfFreedom;
  const double smoothed = belief.nis + kSmoothing * (nis - belief.nis);
  const bool is_moving =
      belief.moving ? smoothed > kSettledSurprise || has_rates(belief.mean, belief.covariance)
                    : smoothed > parameters_.max_still_nis;

  Belief next = is_moving ? moving : still;
  const Innovation i = innovation_of(next);
  const Matrix12x6 gain = i.covariance.solve(i.gain_numerator.transpose()).transpose();
  next.mean += gain * i.value;
  next.covariance -= gain * i.gain_numerator.transpose();
  next.covariance = (0.5 * (next.covariance + next.covariance.transpose())).eval();
  next.mean.segment<3>(kNormal).normalize();
  next.stamp = measurement.stamp;
  next.outliers = {};
  next.scatter.add(told);
  next.nis = smoothed;
  next.moving = is_moving;
  ++next.measurements;
  return next;
}

Expected<TargetEstimate> ConstantVelocity::predict(Time when, const PluginState& state) const {
  const std::optional<Belief> belief = Belief::in(state);
  if (!belief) return refuse("no measurement yet");
  const double dt = to_seconds(when - belief->stamp);
  if (dt > parameters_.max_gap) {
    return refuse(
        fmt::format("{:.2f} s without a measurement, more than {:.2f} s", dt, parameters_.max_gap));
  }
  if (dt < -kMaxBack) {
    return refuse(
        fmt::format("{:.2f} s before the newest measurement, more than {:.2f} s", -dt, kMaxBack));
  }
  Vector12 mean = belief->mean;
  carry_on(mean, dt, belief->moving ? 1.0 : std::exp(-dt / parameters_.decay));
  return estimate_of(when, belief->measurements, mean);
}

}  // namespace armature::target::constant_velocity

ARMATURE_PLUGIN(armature::target::constant_velocity::ConstantVelocity);
