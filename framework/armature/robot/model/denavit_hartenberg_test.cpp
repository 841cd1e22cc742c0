// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/model/denavit_hartenberg.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "armature/robot/kinematics/kinematics.hpp"

namespace armature {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Translation3d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

/// Rz(turn) Tz(slide) in front of a row's Rx(alpha) Tx(a), then Rz(theta) Tz(d): a step between two
/// axes whose frames stand anywhere along them.
Isometry3d step(double turn, double slide, double alpha, double a, double theta, double d) {
  return AngleAxisd{turn, Vector3d::UnitZ()} * Translation3d{0, 0, slide} *
         AngleAxisd{alpha, Vector3d::UnitX()} * Translation3d{a, 0, 0} *
         AngleAxisd{theta, Vector3d::UnitZ()} * Translation3d{0, 0, d};
}

struct Chain {
  std::vector<Isometry3d> before_T_axis;
  std::vector<Joint> joints;
  std::vector<Isometry3d> row_T_axis;
};

Chain convert(std::vector<Isometry3d> before_T_axis) {
  Chain chain{std::move(before_T_axis), {}, {}};
  chain.joints.resize(chain.before_T_axis.size());
  for (std::size_t i = 0; i < chain.joints.size(); ++i) {
    chain.joints[i].type = i % 4 == 2 ? Joint::Type::prismatic : Joint::Type::revolute;
  }
  chain.row_T_axis = to_denavit_hartenberg(chain.before_T_axis, chain.joints);
  return chain;
}

/// The last axis by the rows, and by the steps themselves.
void expect_same_axes(const Chain& chain, std::mt19937& random) {
  const int last = static_cast<int>(chain.joints.size()) - 1;
  const RobotModel model{{"chain",
                          RobotModel::Convention::modified,
                          chain.joints,
                          {{"tool", last, chain.row_T_axis.back()}},
                          FrameId{0},
                          std::nullopt,
                          std::nullopt}};
  std::uniform_real_distribution<double> any{-3, 3};
  for (int n = 0; n < 20; ++n) {
    JointVector q(model.dof());
    for (double& value : q) value = n == 0 ? 0 : any(random);
    Isometry3d T = Isometry3d::Identity();
    for (int i = 0; i <= last; ++i) {
      const auto k = static_cast<std::size_t>(i);
      T = T * chain.before_T_axis[k];
      if (chain.joints[k].type == Joint::Type::prismatic)
        T.translate(Vector3d{0, 0, q[i]});
      else
        T.rotate(AngleAxisd{q[i], Vector3d::UnitZ()});
    }
    const double off = (forward_kinematics(model, q).matrix() - T.matrix()).cwiseAbs().maxCoeff();
    ASSERT_LT(off, 2e-13) << "q " << q.transpose();
  }
}

TEST(DenavitHartenberg, RowsOfAnyChainMoveAsItDoes) {
  std::mt19937 random{71};
  std::uniform_real_distribution<double> any{-1, 1};
  std::uniform_int_distribution<int> choice{0, 5};
  const std::array<double, 6> alphas{0, kPi / 2, -kPi / 2, kPi, 1e-5, 0.7};
  for (int n = 0; n < 300; ++n) {
    std::vector<Isometry3d> steps;
    for (int i = 0; i < 7; ++i) {
      const double alpha = alphas[static_cast<std::size_t>(choice(random))];
      const double a = choice(random) < 3 ? 0 : any(random);
      steps.push_back(
          step(kPi * any(random), any(random), alpha, a, kPi * any(random), any(random)));
    }
    SCOPED_TRACE(::testing::Message() << "seed 71, chain " << n);
    expect_same_axes(convert(steps), random);
  }
}

TEST(DenavitHartenberg, ParallelSquareAndMeetingAxesNeedNoPlacement) {
  std::mt19937 random{72};
  const Chain chain = convert({step(0, 0, 0, 0, 0.3, 0.2), step(0.4, 0.1, kPi / 2, 0.3, 1, 0.5),
                               step(0.2, 0, 0, 0.7, -1, 0), step(1, 0.5, kPi, 0, 0, 0.1),
                               step(0.1, 0, -kPi / 2, 0, 2, 0)});
  const std::array<double, 5> alpha{0, kPi / 2, 0, kPi, kPi / 2}, a{0, 0.3, 0.7, 0, 0};
  for (std::size_t i = 0; i < chain.joints.size(); ++i) {
    EXPECT_FALSE(chain.joints[i].placement) << i;
    EXPECT_NEAR(chain.joints[i].alpha, alpha[i], 1e-15) << i;
    EXPECT_NEAR(chain.joints[i].a, a[i], 1e-15) << i;
  }
  expect_same_axes(chain, random);
}

TEST(DenavitHartenberg, NearlyParallelAxesArePlacedInsteadOfMeetingFarAway) {
  std::mt19937 random{73};
  for (const double alpha : {1e-13, 1e-9, 1e-5, 0.09, kPi - 1e-6}) {
    const Chain chain = convert({step(0, 0, 0, 0, 0, 0.2), step(0.4, 0.1, alpha, 0.3, 1, 0.5),
                                 step(0.2, 0, kPi / 2, 0.7, -1, 0)});
    SCOPED_TRACE(alpha);
    EXPECT_TRUE(chain.joints[1].placement);
    for (const Joint& joint : chain.joints) EXPECT_LT(std::abs(joint.d), 2);
    expect_same_axes(chain, random);
  }
}

TEST(DenavitHartenberg, ABaseThatStandsAskewIsPlaced) {
  std::mt19937 random{74};
  const Isometry3d skew =
      step(0, 0, 0.4, 0, 0.3, 0) * Isometry3d{AngleAxisd{0.5, Vector3d::UnitY()}};
  const Chain chain = convert({skew, step(0.4, 0.1, kPi / 2, 0.3, 1, 0.5)});
  ASSERT_TRUE(chain.joints[0].placement);
  EXPECT_TRUE(chain.joints[0].placement->matrix() == skew.matrix());
  EXPECT_FALSE(chain.joints[1].placement);
  expect_same_axes(chain, random);
}

TEST(DenavitHartenberg, FramesThatStandOnRowsAlreadyGiveThoseRows) {
  const std::array<double, 4> alpha{-kPi / 2, kPi / 2, 0.6, -kPi / 2}, a{0.1, 0.2, 0.3, 0.4},
      theta{0.5, -0.6, 0.7, 0}, d{0.3, 0.2, -0.1, 0};
  std::vector<Isometry3d> steps;
  for (std::size_t i = 0; i < 4; ++i) steps.push_back(step(0, 0, alpha[i], a[i], theta[i], d[i]));
  const Chain chain = convert(steps);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_FALSE(chain.joints[i].placement) << i;
    EXPECT_NEAR(chain.joints[i].alpha, alpha[i], 1e-15) << i;
    EXPECT_NEAR(chain.joints[i].a, a[i], 1e-15) << i;
    EXPECT_NEAR(chain.joints[i].theta, theta[i], 1e-15) << i;
    EXPECT_NEAR(chain.joints[i].d, d[i], 1e-15) << i;
    EXPECT_TRUE(chain.row_T_axis[i].isApprox(Isometry3d::Identity(), 1e-15)) << i;
  }
}

}  // namespace
}  // namespace armature
