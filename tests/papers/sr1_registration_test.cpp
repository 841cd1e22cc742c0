// SPDX-License-Identifier: Apache-2.0
// SR-1, how the head in the images lies before the robot: the markers of the reference case, exact
// and with an error of 0.5 mm, by all three registrations as they are deployed.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "armature/config/document.hpp"
#include "armature/kinds/registration/marker_matching.hpp"
#include "armature/kinds/registration/registration.hpp"
#include "armature/kinds/registration/target_error.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
#include "reference_file.hpp"

namespace armature::paper {
namespace {

constexpr double kMarkerError = 0.0005;  // [m] rms

PluginPtr<Registrar> registrar(const std::string& id) {
  static PluginRegistry plugins{{ARMATURE_PLUGIN_BUILD_DIR}};
  config::Problems problems;
  const Params defaults = Params::read(plugins.find(id)->params, nullptr, id, problems);
  return *plugins.make<Registrar>(id, defaults);
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

Eigen::Vector3d target() { return sr1()["registration"]["case"]["target_image"].point_m(); }

/// Figures are printed to 1e-12 and, lengths, to 1e-9 mm; exact markers to 1e-9 mm.
constexpr double kLastFigure = 1e-11, kLastDigit = 1e-12;

TEST(Sr1Registration, ExactMarkersLeadToTheExactTarget) {
  const Figures figures = sr1()["registration"]["case"];
  for (const char* id : {"registration/affine4", "registration/frame3", "registration/rigid"}) {
    SCOPED_TRACE(id);
    const auto found = registrar(id)->find(markers(6, "robot_markers_exact"));
    ASSERT_TRUE(found) << found.error().text;
    EXPECT_LT((found->robot_T_image.linear() - matrix(figures["R_robot_image"])).norm(),
              kLastFigure);
    EXPECT_LT((found->robot_T_image * target() - figures["target_robot_exact"].point_m()).norm(),
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
  EXPECT_LT((found->robot_T_image * target() - figures["target"].point_m()).norm(), kLastDigit);
  EXPECT_LT(found->fre_m, 1e-15) << figures["fre"].number();
  EXPECT_NEAR(found->condition, 3.03, 0.005);
}

TEST(Sr1Registration, ThreeMarkersMakeTheFrameOfTheCase) {
  const Figures figures = sr1()["registration"]["case"]["noisy_frame3"];
  const auto found = registrar("registration/frame3")->find(markers(3, "robot_markers_noisy"));
  ASSERT_TRUE(found) << found.error().text;
  EXPECT_LT((found->robot_T_image.linear() - matrix(figures["T"])).norm(), kLastFigure);
  EXPECT_LT((found->robot_T_image * target() - figures["target"].point_m()).norm(), kLastDigit);
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
    EXPECT_LT((found->robot_T_image * target() - figures["target"].point_m()).norm(), kLastDigit);
    EXPECT_NEAR(1e3 * found->fre_m, figures["fre_rms"].number(), 1e-9);
    // Fitzpatrick's formula is that of markers without error.
    const auto error =
        predicted_error(*rigid, markers(count, "robot_markers_exact"), target(), kMarkerError);
    ASSERT_TRUE(error);
    EXPECT_NEAR(1e3 * error->rms_m, figures["fitzpatrick_tre_rms_for_fle_0p5"].number(), 1e-6);
  }
}

TEST(Sr1Registration, TheErrorsOfAllMethodsAreThoseOfTheSimulation) {
  const Figures simulated = sr1()["registration"]["montecarlo"]["tre_rms_p95_mm"];
  struct Method {
    const char *figures, *id;
    std::size_t count;
  };
  for (const auto& [name, id, count] :
       {Method{"affine4", "registration/affine4", 4}, Method{"frame3", "registration/frame3", 3},
        Method{"kabsch3", "registration/rigid", 3}, Method{"kabsch4", "registration/rigid", 4},
        Method{"kabsch6", "registration/rigid", 6}}) {
    SCOPED_TRACE(name);
    const auto error = predicted_error(*registrar(id), markers(count, "robot_markers_exact"),
                                       target(), kMarkerError);
    ASSERT_TRUE(error);
    // 20 000 trials know the rms to 0.4 % and the quantile to 0.7 %; one sigma each.
    EXPECT_NEAR(1e3 * error->rms_m / simulated[name][0].number(), 1, 0.012);
    EXPECT_NEAR(1e3 * error->bound95_m / simulated[name][1].number(), 1, 0.02);
  }
}

TEST(Sr1Registration, UnorderedMarkersFindTheirNames) {
  const Figures figures = sr1()["registration"]["case"]["unordered"];
  const auto match =
      match_markers(markers(4, "robot_markers_exact").image, points(figures["measured"]),
                    1e-3 * figures["tolerance_mm"].number());
  ASSERT_TRUE(match) << match.error().text;
  const Eigen::VectorXd expected = figures["expected_assignment_ref_to_measured"].numbers();
  for (std::size_t i = 0; i < match->size(); ++i) {
    EXPECT_EQ(static_cast<double>((*match)[i]), expected[static_cast<Eigen::Index>(i)]) << i;
  }
}

}  // namespace
}  // namespace armature::paper
