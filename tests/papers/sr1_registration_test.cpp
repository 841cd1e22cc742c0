// SPDX-License-Identifier: Apache-2.0
// SR-1, how the head in the images lies before the robot: the markers of the reference case, exact
// and with an error of 0.5 mm, by all three registrations as they are deployed.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "armature/config/document.hpp"
#include "armature/kinds/registration/marker_matching.hpp"
#include "armature/kinds/registration/registration.hpp"
#include "armature/runtime/testing/test_plugins.hpp"
#include "reference_file.hpp"

namespace armature::paper {
namespace {

PluginPtr<Registrar> registrar(const std::string& id) {
  config::Problems problems;
  const Params defaults = Params::read(built_plugins().find(id)->params, nullptr, id, problems);
  return *built_plugins().make<Registrar>(id, defaults);
}

std::vector<Eigen::Vector3d> points(const Figures& figures) {
  std::vector<Eigen::Vector3d> all;
  for (std::size_t i = 0; i < figures.size(); ++i) all.push_back(figures[i].point_m());
  return all;
}

/// The first `count` markers of the case.
MarkerPairs markers(std::size_t count, const char* robot) {
  const Figures figures = sr1()["registration"]["case"];
  MarkerPairs pairs{points(figures["image_markers"]), points(figures[robot])};
  pairs.image.resize(count);
  pairs.robot.resize(count);
  return pairs;
}

Eigen::Matrix3d matrix(const Figures& rows) {
  Eigen::Matrix3d m;
  for (std::size_t i = 0; i < 3; ++i)
    m.row(static_cast<Eigen::Index>(i)) = rows[i].numbers().head<3>();
  return m;
}

/// The last column of a transform.
Eigen::Vector3d translation(const Figures& rows) {
  Eigen::Vector3d t;
  for (std::size_t i = 0; i < 3; ++i) t[static_cast<Eigen::Index>(i)] = 1e-3 * rows[i][3].number();
  return t;
}

/// Figures are printed to 1e-12 and, lengths, to 1e-9 mm; exact markers to 1e-9 mm.
constexpr double kLastFigure = 1e-11, kLastDigit = 1e-12;

TEST(Sr1Registration, ExactMarkersLeadToTheExactMap) {
  const Figures figures = sr1()["registration"]["case"];
  for (const char* id : {"registration/affine4", "registration/frame3", "registration/rigid"}) {
    SCOPED_TRACE(id);
    const auto found = registrar(id)->find(markers(6, "robot_markers_exact"));
    ASSERT_TRUE(found) << found.error().text;
    EXPECT_LT((found->robot_T_image.linear() - matrix(figures["R_robot_image"])).norm(),
              kLastFigure);
    EXPECT_LT((found->robot_T_image.translation() - figures["t_robot_image"].point_m()).norm(),
              2e-12);
    EXPECT_LT(found->fre_m, 1e-12);
  }
}

TEST(Sr1Registration, FourMarkersMakeTheAffineMapOfTheCase) {
  const Figures figures = sr1()["registration"]["case"]["noisy_affine4"];
  const auto found = registrar("registration/affine4")->find(markers(4, "robot_markers_noisy"));
  ASSERT_TRUE(found) << found.error().text;
  EXPECT_LT((found->robot_T_image.linear() - matrix(figures["A"])).norm(), kLastFigure);
  EXPECT_LT((found->robot_T_image.translation() - figures["b"].point_m()).norm(), kLastDigit);
}

TEST(Sr1Registration, ThreeMarkersMakeTheFrameOfTheCase) {
  const Figures figures = sr1()["registration"]["case"]["noisy_frame3"];
  const auto found = registrar("registration/frame3")->find(markers(3, "robot_markers_noisy"));
  ASSERT_TRUE(found) << found.error().text;
  EXPECT_LT((found->robot_T_image.linear() - matrix(figures["T"])).norm(), kLastFigure);
  EXPECT_LT((found->robot_T_image.translation() - translation(figures["T"])).norm(), kLastDigit);
}

TEST(Sr1Registration, LeastSquaresOverThreeFourAndSixMarkersIsThatOfTheCase) {
  for (const auto& [count, name] : {std::pair{3u, "noisy_kabsch3"}, std::pair{4u, "noisy_kabsch4"},
                                    std::pair{6u, "noisy_kabsch6"}}) {
    SCOPED_TRACE(count);
    const Figures figures = sr1()["registration"]["case"][name];
    const MarkerPairs pairs = markers(count, "robot_markers_noisy");
    const auto rigid = registrar("registration/rigid");
    const auto found = rigid->find(pairs);
    ASSERT_TRUE(found) << found.error().text;
    EXPECT_LT((found->robot_T_image.linear() - matrix(figures["R"])).norm(), kLastFigure);
    EXPECT_LT((found->robot_T_image.translation() - figures["t"].point_m()).norm(), kLastDigit);
  }
}

TEST(Sr1Registration, UnorderedMarkersFindTheirNames) {
  const Figures figures = sr1()["registration"]["case"]["unordered"];
  const auto match =
      match_markers(markers(4, "robot_markers_exact").image, points(figures["measured"]),
                    1e-3 * figures["tolerance_mm"].number());
  ASSERT_TRUE(match) << match.error().text;
  const Eigen::VectorXd expected = figures["expected_assignment_ref_to_measured"].numbers();
  for (std::size_t i = 0; i < match->measured.size(); ++i) {
    EXPECT_EQ(static_cast<double>(match->measured[i]), expected[static_cast<Eigen::Index>(i)]) << i;
  }
}

}  // namespace
}  // namespace armature::paper
