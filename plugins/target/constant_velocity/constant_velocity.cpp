// SPDX-License-Identifier: Apache-2.0
#include "constant_velocity.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "armature/runtime/plugin.hpp"

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
constexpr double kLeastSigma_m = 1e-6, kLeastSigma_rad = 1e-6;

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

/// Variances that a rate of variance `rate` and an acceleration of variance `acceleration`, both
/// constant over dt and unknown, add to one block.
void add_process_noise(Matrix12& covariance, int block, double dt, double rate,
                       double acceleration) {
  const double dt2 = dt * dt;
  covariance.block<3, 3>(block, block).diagonal().array() += 0.25 * acceleration * dt2 * dt2;
  covariance.block<3, 3>(block, block + 3).diagonal().array() += 0.5 * acceleration * dt2 * dt;
  covariance.block<3, 3>(block + 3, block).diagonal().array() += 0.5 * acceleration * dt2 * dt;
  covariance.block<3, 3>(block + 3, block + 3).diagonal().array() += acceleration * dt2 + rate;
}

Matrix6 measurement_noise(const TargetMeasurement& m) {
  const double position = std::max(m.position_sigma_m, kLeastSigma_m);
  const double normal = std::max(m.normal_sigma_rad, kLeastSigma_rad);
  Matrix6 r = Matrix6::Zero();
  r.topLeftCorner<3, 3>().diagonal().setConstant(position * position);
  r.bottomRightCorner<3, 3>().diagonal().setConstant(normal * normal);
  return r;
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

Innovation innovation(const TargetMeasurement& m, const TargetFilter::State& state) {
  Innovation result;
  result.value << m.position - state.mean.segment<3>(kPosition),
      m.normal - state.mean.segment<3>(kNormal);
  result.gain_numerator = measured_columns(state.covariance);
  const Matrix6 s = measured_block(result.gain_numerator) + measurement_noise(m);
  result.covariance.compute(s);
  result.normalised = result.value.dot(result.covariance.solve(result.value));
  return result;
}

/// Are the rates larger than their uncertainty explains?
bool has_rates(const TargetFilter::State& state) {
  Vector6 rates;
  rates << state.mean.segment<3>(kVelocity), state.mean.segment<3>(kNormalRate);
  Vector6 variances;
  variances << state.covariance.diagonal().segment<3>(kVelocity),
      state.covariance.diagonal().segment<3>(kNormalRate);
  return rates.cwiseAbs2().cwiseQuotient(variances).mean() > kSettledRates;
}

TargetEstimate estimate_of(const TargetFilter::State& state) {
  const Eigen::Vector3d normal = state.mean.segment<3>(kNormal).normalized();
  const Eigen::Vector3d rate = state.mean.segment<3>(kNormalRate);
  return {.stamp = state.stamp,
          .position = state.mean.segment<3>(kPosition),
          .normal = normal,
          .velocity = state.mean.segment<3>(kVelocity),
          .normal_rate = rate - normal * normal.dot(rate),
          .measurements = state.measurements};
}

}  // namespace

Expected<std::unique_ptr<TargetFilter>> ConstantVelocity::make(const Params& params) {
  return std::make_unique<ConstantVelocity>(Parameters::read(params));
}

void ConstantVelocity::start(const TargetMeasurement& measurement, State& state) const {
  state = State{};
  state.started = true;
  state.stamp = measurement.stamp;
  state.measurements = 1;
  state.mean.segment<3>(kPosition) = measurement.position;
  state.mean.segment<3>(kNormal) = measurement.normal;
  const Matrix6 r = measurement_noise(measurement);
  const auto squared = [](double x) { return x * x; };
  state.covariance.diagonal() << r.diagonal().head<3>(),
      Eigen::Vector3d::Constant(squared(parameters_.still_speed)), r.diagonal().tail<3>(),
      Eigen::Vector3d::Constant(squared(parameters_.still_turn));
}

void ConstantVelocity::advance(State& state, double dt_s, bool moving) const {
  const double decay = moving ? 1.0 : std::exp(-dt_s / parameters_.decay);
  carry_on(state.mean, dt_s, decay);
  carry_on(state.covariance, dt_s, decay);
  const auto noise = [&](int block, double still, double acceleration) {
    // What decays comes back as noise, so that a still target's rates keep their variance.
    const double rate = moving ? 0 : still * still * (1 - decay * decay);
    add_process_noise(state.covariance, block, dt_s, rate,
                      moving ? acceleration * acceleration : 0);
  };
  noise(kPosition, parameters_.still_speed, parameters_.acceleration);
  noise(kNormal, parameters_.still_turn, parameters_.turn_acceleration);
  state.stamp = state.stamp + seconds(dt_s);
}

Expected<TargetEstimate> ConstantVelocity::update(const TargetMeasurement& measurement,
                                                  State& state) const {
  if (!measurement.position.allFinite() || !measurement.normal.allFinite() ||
      !std::isfinite(measurement.position_sigma_m) ||
      !std::isfinite(measurement.normal_sigma_rad) || measurement.normal.norm() < 0.5) {
    return refuse("the measurement is not finite, or its normal is no unit vector");
  }
  const double dt = to_seconds(measurement.stamp - state.stamp);
  if (!state.started || dt > parameters_.max_gap) {
    start(measurement, state);
    return estimate_of(state);
  }
  if (dt <= 0) {
    return refuse(fmt::format("the measurement is {:.1f} ms older than the newest one", -dt * 1e3));
  }

  State still = state, moving = state;
  advance(still, dt, false);
  advance(moving, dt, true);
  const Vector6 off = innovation(measurement, moving).value;
  const double distance = off.head<3>().norm();
  const double angle = 2 * std::asin(std::min(0.5 * off.tail<3>().norm(), 1.0));
  if (distance > parameters_.outlier_position || angle > parameters_.outlier_angle) {
    if (++state.rejected < parameters_.restart_after) {
      return refuse(
          fmt::format("outlier: {:.0f} mm and {:.0f} degrees from where the target "
                      "should be, more than {:.0f} mm or {:.0f} degrees",
                      distance * 1e3, angle * kDegreesPerRadian, parameters_.outlier_position * 1e3,
                      parameters_.outlier_angle * kDegreesPerRadian));
    }
    start(measurement, state);
    return estimate_of(state);
  }

  const double surprise = innovation(measurement, still).normalised / kDegreesOfFreedom;
  const double smoothed = state.surprise + kSmoothing * (surprise - state.surprise);
  const bool is_moving = state.moving ? smoothed > kSettledSurprise || has_rates(state)
                                      : smoothed > parameters_.surprise;

  State next = is_moving ? moving : still;
  const Innovation i = innovation(measurement, next);
  const Matrix12x6 gain = i.covariance.solve(i.gain_numerator.transpose()).transpose();
  next.mean += gain * i.value;
  next.covariance -= gain * i.gain_numerator.transpose();
  next.covariance = (0.5 * (next.covariance + next.covariance.transpose())).eval();
  next.mean.segment<3>(kNormal).normalize();
  next.stamp = measurement.stamp;
  next.rejected = 0;
  next.surprise = smoothed;
  next.moving = is_moving;
  ++next.measurements;
  state = next;
  return estimate_of(state);
}

Expected<TargetEstimate> ConstantVelocity::predict(Time when, const State& state) const {
  if (!state.started) return refuse("no measurement yet");
  const double dt = to_seconds(when - state.stamp);
  if (dt > parameters_.max_gap) {
    return refuse(
        fmt::format("{:.2f} s without a measurement, more than {:.2f} s", dt, parameters_.max_gap));
  }
  State later = state;
  const double decay = state.moving ? 1.0 : std::exp(-dt / parameters_.decay);
  carry_on(later.mean, dt, decay);
  later.stamp = when;
  return estimate_of(later);
}

}  // namespace armature::target::constant_velocity

ARMATURE_PLUGIN(armature::target::constant_velocity::ConstantVelocity);
