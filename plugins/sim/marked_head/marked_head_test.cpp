// SPDX-License-Identifier: Apache-2.0
// What is measured on a marked head, and how well it leads to the target.
#include "marked_head.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "armature/config/document.hpp"
#include "armature/kinds/registration/explained_fit.hpp"
#include "armature/kinds/registration/marker_matching.hpp"
#include "armature/kinds/registration/registration.hpp"
#include "armature/kinds/registration/target_error.hpp"
#include "armature/runtime/testing/test_plugins.hpp"

namespace armature::sim::marked_head {
namespace {

MarkedHead head() {
  MarkedHead head{.markers = {{0.0886, 0, 0.0156},
                              {-0.0151, 0.0856, 0.0233},
                              {-0.0219, -0.0817, 0.0308},
                              {0.0219, 0.0080, 0.0869},
                              {-0.0779, 0, 0.0450},
                              {0.0318, 0.0551, 0.0636}},
                  .entry = {0, 0.06, 0.07},
                  .target = {0.01, 0.005, 0.012}};
  head.robot_T_image = Eigen::Translation3d{0.45, -0.12, 0.26} *
                       Eigen::AngleAxisd{1.1, Eigen::Vector3d{1, 2, -1}.normalized()};
  return head;
}

PluginPtr<Registrar> rigid() {
  config::Problems problems;
  const std::string id = "registration/rigid";
  return *built_plugins().make<Registrar>(
      id, Params::read(built_plugins().find(id)->params, nullptr, id, problems));
}

TEST(MarkedHeads, AreFoundInAnOrderThatTheSeedDecides) {
  const auto first = measured_points(head(), {.marker_error = 0, .spurious_points = 2}, 1);
  EXPECT_EQ(first.size(), 8u);
  EXPECT_EQ(first, measured_points(head(), {.marker_error = 0, .spurious_points = 2}, 1));
  EXPECT_NE(first, measured_points(head(), {.marker_error = 0, .spurious_points = 2}, 2));
  for (const Eigen::Vector3d& marker : head().markers) {
    double nearest = 1;
    for (const Eigen::Vector3d& point : first) {
      nearest = std::min(nearest, (point - head().robot_T_image * marker).norm());
    }
    EXPECT_LT(nearest, 1e-15);
  }
}

TEST(MarkedHeads, ATargetIsOffByAsMuchAsPredicted) {
  constexpr double kMarkerError = 0.0005;
  const auto registrar = rigid();
  for (const std::size_t count : {4u, 6u}) {
    MarkedHead marked = head();
    marked.markers.resize(count);
    MarkerPairs exact{marked.markers, {}};
    for (const auto& marker : marked.markers) exact.robot.push_back(marked.robot_T_image * marker);
    const auto predicted = predicted_error(*registrar, exact, marked.target, kMarkerError);
    ASSERT_TRUE(predicted);
    double sum = 0;
    constexpr int kSeeds = 1000;
    int beyond = 0;
    for (int seed = 1; seed <= kSeeds; ++seed) {
      const auto points =
          measured_points(marked, {.marker_error = kMarkerError, .spurious_points = 2},
                          static_cast<std::uint64_t>(seed));
      const auto match = match_markers(marked.markers, points, 0.003);
      ASSERT_TRUE(match) << "seed " << seed << ": " << match.error().text;
      MarkerPairs markers{marked.markers, {}};
      for (const std::size_t i : match->measured) markers.robot.push_back(points[i]);
      const auto found = registrar->find(markers);
      ASSERT_TRUE(found) << "seed " << seed << ": " << found.error().text;
      const double off =
          (found->robot_T_image * marked.target - marked.robot_T_image * marked.target).norm();
      sum += off * off;
      if (off > predicted->bound95_m) ++beyond;
      EXPECT_FALSE(unexplained_fit(markers, *found, kMarkerError)) << "seed " << seed;
    }
    EXPECT_NEAR(std::sqrt(sum / kSeeds) / predicted->rms_m, 1, 0.1) << count << " markers";
    EXPECT_NEAR(static_cast<double>(beyond) / kSeeds, 0.05, 0.02) << count << " markers";
  }
}

}  // namespace
}  // namespace armature::sim::marked_head
