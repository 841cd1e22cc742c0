// SPDX-License-Identifier: Apache-2.0
#include "rigid.hpp"

#include <Eigen/Eigenvalues>

#include "armature/kinds/registration/contract.hpp"
#include "armature/kinds/registration/moved_head.hpp"
#include "armature/kinds/registration/target_error.hpp"

namespace armature::registration::rigid {
namespace {

INSTANTIATE_TEST_SUITE_P(
    Rigid, RegistrationLaws,
    testing::Values(RegistrationSubject{"rigid", std::make_shared<Rigid>(Parameters{}), 3},
                    RegistrationSubject{"all_markers",
                                        std::make_shared<Rigid>(Parameters{.outlier = 0}), 3}));

class RigidRegistration : public testing::Test, public MovedHead {
 protected:
  static MarkerPairs first(std::size_t count, MarkerPairs markers) {
    markers.image.resize(count);
    markers.robot.resize(count);
    return markers;
  }
  const Registrar& registrar() const { return rigid_; }

 private:
  const Rigid rigid_{Parameters{}};
};

/// TRE^2 = FLE^2 / N (1 + 1/3 sum d_k^2 / f_k^2), k over the principal axes of the markers.
double fitzpatrick(const std::vector<Eigen::Vector3d>& markers, const Eigen::Vector3d& target,
                   double marker_error_m) {
  const double n = static_cast<double>(markers.size());
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& marker : markers) centroid += marker / n;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& marker : markers) {
    scatter += (marker - centroid) * (marker - centroid).transpose() / n;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes{scatter};
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d axis = axes.eigenvectors().col(k);
    const double f2 = scatter.trace() - axes.eigenvalues()[k];
    sum += (target - centroid).cross(axis).squaredNorm() / f2;
  }
  return marker_error_m * std::sqrt((1 + sum / 3) / n);
}

TEST_F(RigidRegistration, ThePredictedErrorIsFitzpatricks) {
  for (const std::size_t count : {3u, 4u, 6u}) {
    const MarkerPairs markers = first(count, seen(random_motion()));
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector3d target = gauss(0.05);
      const auto error = predicted_error(registrar(), markers, target, 0.0005);
      ASSERT_TRUE(error);
      EXPECT_NEAR(error->rms_m / fitzpatrick(markers.image, target, 0.0005), 1, 1e-6);
    }
  }
}

TEST_F(RigidRegistration, TheFiducialErrorIsWhatTheMarkersErrorMakesIt) {
  for (const std::size_t count : {3u, 4u, 6u}) {
    const MarkerPairs exact = first(count, seen(random_motion()));
    double sum = 0;
    constexpr int kTrials = 20000;
    for (int i = 0; i < kTrials; ++i) {
      const auto found = registrar().find(with_noise(exact, 0.0005));
      ASSERT_TRUE(found);
      sum += found->fre_m * found->fre_m;
    }
    const double expected = 0.0005 * std::sqrt(1 - 2 / static_cast<double>(count));
    EXPECT_NEAR(std::sqrt(sum / kTrials) / expected, 1, 0.02) << count;
  }
}

TEST_F(RigidRegistration, LeavesOutMarkersThatMoved) {
  for (int i = 0; i < 200; ++i) {
    MarkerPairs markers = with_noise(seen(random_motion()), 0.0005);
    const std::size_t one = static_cast<std::size_t>(i) % 6;
    const std::size_t other = (one + 1 + static_cast<std::size_t>(i) % 5) % 6;
    markers.robot[one] += 0.02 * gauss(1).normalized();
    if (i % 2 == 0) markers.robot[other] += 0.03 * gauss(1).normalized();
    const auto found = registrar().find(markers);
    ASSERT_TRUE(found) << found.error().text;
    for (std::size_t k = 0; k < 6; ++k) {
      EXPECT_EQ(found->used[k], k != one && (i % 2 != 0 || k != other)) << k;
    }
    EXPECT_GT(found->residual_m[one], 0.01);
    EXPECT_LT(found->fre_m, 0.001);
  }
}

TEST_F(RigidRegistration, RefusesMarkersOfWhichNobodyCanSayWhichIsWrong) {
  MarkerPairs markers = seen(random_motion());
  MarkerPairs three = first(3, markers), four = first(4, markers);
  three.robot[1] += Eigen::Vector3d{0.03, 0, 0};
  four.robot[1] += Eigen::Vector3d{0.03, 0, 0};
  EXPECT_EQ(registrar().find(three).error().text,
            "the three markers do not fit to within 3 mm (outlier_mm)");
  EXPECT_EQ(registrar().find(four).error().text,
            "the markers disagree: no four of 4 fit to within 3 mm (outlier_mm)");
}

TEST_F(RigidRegistration, RefusesTwoGroupsOfMarkersThatEachMovedAsOne) {
  MarkerPairs markers = seen(random_motion());
  for (std::size_t i = 0; i < 2; ++i) {
    markers.image.push_back(markers.image[i] + Eigen::Vector3d{0.02, 0.01, -0.03});
    markers.robot.push_back(markers.robot[i] + Eigen::Vector3d{0.04, 0, 0.05});
  }
  const Eigen::Isometry3d other = random_motion();
  for (std::size_t i = 4; i < 8; ++i) markers.robot[i] = other * markers.image[i];
  EXPECT_EQ(registrar().find(markers).error().text,
            "the markers disagree: two different sets of 4 fit to within 3 mm (outlier_mm)");
}

TEST_F(RigidRegistration, RefusesAMirrorImage) {
  MarkerPairs markers = seen(random_motion());
  for (Eigen::Vector3d& marker : markers.robot) marker.y() = -marker.y();
  EXPECT_EQ(registrar().find(markers).error().text,
            "the robot's markers are the mirror image of the image's: is an axis of the images "
            "turned round?");
}

}  // namespace
}  // namespace armature::registration::rigid
