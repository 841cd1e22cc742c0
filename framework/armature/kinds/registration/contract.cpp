// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/registration/contract.hpp"

#include <cmath>

namespace armature {

std::vector<Eigen::Vector3d> RegistrationLaws::head() {
  return {{0.0886, 0, 0.0156},      {-0.0151, 0.0856, 0.0233}, {-0.0219, -0.0817, 0.0308},
          {0.0219, 0.0080, 0.0869}, {-0.0779, 0, 0.0450},      {0.0318, 0.0551, 0.0636}};
}

Eigen::Vector3d RegistrationLaws::gauss(double sigma) {
  return sigma * Eigen::Vector3d{normal_(random_), normal_(random_), normal_(random_)};
}

Eigen::Isometry3d RegistrationLaws::random_motion() {
  const Eigen::Vector4d any{normal_(random_), normal_(random_), normal_(random_), normal_(random_)};
  return Eigen::Translation3d{gauss(0.5)} * Eigen::Quaterniond{Eigen::Vector4d{any.normalized()}};
}

MarkerPairs RegistrationLaws::seen(const Eigen::Isometry3d& robot_T_image) {
  MarkerPairs markers{head(), {}};
  for (const Eigen::Vector3d& marker : markers.image) {
    markers.robot.push_back(robot_T_image * marker);
  }
  return markers;
}

MarkerPairs RegistrationLaws::with_noise(MarkerPairs markers, double marker_error_m) {
  for (Eigen::Vector3d& marker : markers.robot) marker += gauss(marker_error_m / std::sqrt(3.0));
  return markers;
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(RegistrationLaws);

TEST_P(RegistrationLaws, FindsTheMotionThatMovedTheMarkersWithoutError) {
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Isometry3d truth = random_motion();
    const auto found = registrar().find(seen(truth));
    ASSERT_TRUE(found) << found.error().text;
    EXPECT_LT((found->robot_T_image.matrix() - truth.matrix()).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT(found->fre_m, 1e-12);
    EXPECT_GE(found->condition, 1);
    EXPECT_TRUE(std::isfinite(found->condition));
  }
}

TEST_P(RegistrationLaws, TellsEveryResidualAndTheirMeanSquareOverTheMarkersUsed) {
  const MarkerPairs markers = with_noise(seen(random_motion()), 0.0005);
  const auto found = registrar().find(markers);
  ASSERT_TRUE(found) << found.error().text;
  ASSERT_EQ(found->residual_m.size(), markers.image.size());
  ASSERT_EQ(found->used.size(), markers.image.size());
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < markers.image.size(); ++i) {
    const double off = (found->robot_T_image * markers.image[i] - markers.robot[i]).norm();
    EXPECT_NEAR(found->residual_m[i], off, 1e-15);
    if (found->used[i]) sum += off * off, count += 1;
  }
  EXPECT_GE(count, GetParam().least);
  EXPECT_NEAR(found->fre_m, std::sqrt(sum / count), 1e-15);
}

TEST_P(RegistrationLaws, DoesNotDependOnWhereTheFramesStand) {
  const MarkerPairs markers = with_noise(seen(random_motion()), 0.0005);
  const auto found = registrar().find(markers);
  ASSERT_TRUE(found);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Isometry3d left = random_motion(), right = random_motion();
    MarkerPairs moved = markers;
    for (Eigen::Vector3d& marker : moved.robot) marker = left * marker;
    for (Eigen::Vector3d& marker : moved.image) marker = right * marker;
    const auto again = registrar().find(moved);
    ASSERT_TRUE(again);
    const Eigen::Affine3d expected = left * found->robot_T_image * right.inverse();
    EXPECT_LT((again->robot_T_image.matrix() - expected.matrix()).cwiseAbs().maxCoeff(), 1e-11);
    EXPECT_NEAR(again->fre_m, found->fre_m, 1e-12);
  }
}

TEST_P(RegistrationLaws, TheErrorAtATargetIsAsPredicted) {
  constexpr double kMarkerError = 0.0005;  // [m]
  constexpr int kTrials = 20000;           // the rms is known to 0.4 %, the quantile to 0.7 %
  for (const Eigen::Vector3d& target :
       {Eigen::Vector3d{0.012, -0.008, 0.015}, Eigen::Vector3d{0, 0, -0.06}}) {
    const MarkerPairs exact = seen(random_motion());
    const auto truth = registrar().find(exact);
    const auto predicted = predicted_error(registrar(), exact, target, kMarkerError);
    ASSERT_TRUE(truth && predicted);
    double sum = 0;
    int beyond = 0;
    for (int i = 0; i < kTrials; ++i) {
      const auto found = registrar().find(with_noise(exact, kMarkerError));
      ASSERT_TRUE(found) << found.error().text;
      const double off = (found->robot_T_image * target - truth->robot_T_image * target).norm();
      sum += off * off;
      if (off > predicted->bound95_m) ++beyond;
    }
    EXPECT_NEAR(std::sqrt(sum / kTrials) / predicted->rms_m, 1, 0.02);
    EXPECT_NEAR(static_cast<double>(beyond) / kTrials, 0.05, 0.006);
  }
}

TEST_P(RegistrationLaws, GivesTheSameBitsForTheSameMarkers) {
  const MarkerPairs markers = with_noise(seen(random_motion()), 0.0005);
  const auto first = registrar().find(markers);
  static_cast<void>(registrar().find(seen(random_motion())));
  const auto second = registrar().find(markers);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->robot_T_image.matrix(), second->robot_T_image.matrix());
  EXPECT_EQ(first->fre_m, second->fre_m);
}

TEST_P(RegistrationLaws, RefusesMarkersThatDetermineNothingAndGoesOn) {
  const MarkerPairs good = seen(random_motion());
  const auto refusal = [&](auto change) {
    MarkerPairs bad = good;
    change(bad);
    const auto found = registrar().find(bad);
    EXPECT_FALSE(found);
    EXPECT_TRUE(registrar().find(good));
    return found ? "" : found.error().text;
  };
  const std::size_t too_few = GetParam().least - 1;
  EXPECT_EQ(refusal([&](auto& m) { m.image.resize(too_few), m.robot.resize(too_few); }),
            std::to_string(too_few) + " markers, at least " + std::to_string(GetParam().least) +
                " are needed");
  EXPECT_EQ(refusal([](auto& m) { m.robot.pop_back(); }),
            "6 markers in the image, 5 before the robot");
  EXPECT_EQ(refusal([](auto& m) { m.image[1].y() = NAN; }), "marker 2 of the image is not finite");
  EXPECT_EQ(refusal([](auto& m) { m.robot[2].x() = INFINITY; }),
            "marker 3 of the robot is not finite");
  const auto on_a_line = [](auto& m) {
    for (std::size_t i = 0; i < m.image.size(); ++i) {
      m.image[i] = m.robot[i] = Eigen::Vector3d{0.02, 0.03, -0.01} * static_cast<double>(i);
    }
  };
  EXPECT_NE(refusal(on_a_line).find("lie nearly "), std::string::npos) << refusal(on_a_line);
  const auto in_one_place = [](auto& m) {
    for (std::size_t i = 0; i < m.image.size(); ++i) m.image[i] = m.robot[i] = {0.1, 0.2, 0.3};
  };
  EXPECT_NE(refusal(in_one_place).find("lie nearly "), std::string::npos) << refusal(in_one_place);
}
}  // namespace armature
