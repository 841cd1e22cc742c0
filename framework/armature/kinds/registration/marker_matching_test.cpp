// SPDX-License-Identifier: Apache-2.0
// Unordered markers find their names by their distances.
#include "armature/kinds/registration/marker_matching.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <ctime>
#include <numeric>
#include <random>

namespace armature {
namespace {

using Points = std::vector<Eigen::Vector3d>;

class MarkerMatching : public testing::Test {
 protected:
  static Points head() {
    return {{0.0886, 0, 0.0156},      {-0.0151, 0.0856, 0.0233}, {-0.0219, -0.0817, 0.0308},
            {0.0219, 0.0080, 0.0869}, {-0.0779, 0, 0.0450},      {0.0318, 0.0551, 0.0636}};
  }
  static Points first(std::size_t count) {
    Points points = head();
    points.resize(count);
    return points;
  }
  Eigen::Isometry3d random_motion() {
    const Eigen::Vector4d any{normal_(random_), normal_(random_), normal_(random_),
                              normal_(random_)};
    return Eigen::Translation3d{gauss(0.5)} * Eigen::Quaterniond{Eigen::Vector4d{any.normalized()}};
  }
  Eigen::Vector3d gauss(double sigma) {
    return sigma * Eigen::Vector3d{normal_(random_), normal_(random_), normal_(random_)};
  }
  /// The planned markers and `spurious` other points before the robot, in any order; where each
  /// planned one went.
  Points shuffled(const Points& planned, std::size_t spurious, double marker_error_m,
                  std::vector<std::size_t>& where) {
    std::vector<std::size_t> place(planned.size() + spurious);
    std::iota(place.begin(), place.end(), 0u);
    std::shuffle(place.begin(), place.end(), random_);
    where.assign(place.begin(), place.begin() + static_cast<std::ptrdiff_t>(planned.size()));
    const Eigen::Isometry3d motion = random_motion();
    Points points(place.size());
    for (std::size_t i = 0; i < place.size(); ++i) {
      points[place[i]] = i < planned.size()
                             ? motion * planned[i] + gauss(marker_error_m / std::sqrt(3.0))
                             : motion * gauss(0.1);
    }
    return points;
  }

  std::mt19937_64 random_{7};
  std::normal_distribution<double> normal_;
};

constexpr double kMarkerError = 0.0005, kTolerance = 0.003;  // [m]

TEST_F(MarkerMatching, NamesEveryMarkerAmongSpuriousPoints) {
  for (const auto& [count, spurious] : {std::pair{6u, 2u}, std::pair{4u, 0u}}) {
    for (int i = 0; i < 2000; ++i) {
      std::vector<std::size_t> where;
      const Points planned = first(count);
      const Points points = shuffled(planned, spurious, kMarkerError, where);
      const auto match = match_markers(planned, points, kTolerance);
      ASSERT_TRUE(match) << match.error().text;
      EXPECT_EQ(match->measured, where);
    }
  }
}

TEST_F(MarkerMatching, RefusesAMirrorImageAlthoughAllDistancesAgree) {
  std::vector<std::size_t> where;
  for (const std::size_t count : {4u, 6u}) {
    Points points = shuffled(first(count), 0, 0, where);
    for (Eigen::Vector3d& point : points) point.x() = -point.x();
    const auto match = match_markers(first(count), points, kTolerance);
    ASSERT_FALSE(match);
    EXPECT_EQ(match.error().text,
              "the measured markers are the mirror image of the planned ones: is an axis of the "
              "images turned round?");
  }
}

TEST_F(MarkerMatching, AsksWhetherAMarkerWasMeasuredTwice) {
  Points measured = head();
  measured.push_back(measured[2] + Eigen::Vector3d{0.0002, 0, 0});
  const auto match = match_markers(head(), measured, kTolerance);
  ASSERT_FALSE(match);
  EXPECT_TRUE(match.error().text.starts_with(
      "ambiguous: points 3 and 7 may both be marker 3, was it measured twice? (fits to 0.000 mm, "
      "the other way to "))
      << match.error().text;
}

TEST_F(MarkerMatching, SaysWhichMarkersCouldBeExchanged) {
  // Markers 2 and 4 are alike seen from the others, which lie in one plane with the middle.
  const Points planned{{0.1, 0, 0}, {0, 0.05, 0}, {-0.06, 0, 0}, {0, -0.05, 0}};
  std::vector<std::size_t> where;
  const auto match = match_markers(planned, shuffled(planned, 0, 0, where), kTolerance);
  ASSERT_FALSE(match);
  EXPECT_EQ(match.error().text.substr(0, 45), "ambiguous: markers 2, 4 may be exchanged (fit");
}

TEST_F(MarkerMatching, SaysWhichMarkerHasNoPlace) {
  std::vector<std::size_t> where;
  Points points = shuffled(head(), 0, 0, where);
  points[where[3]] += Eigen::Vector3d{0.02, 0, 0};
  const auto match = match_markers(head(), points, kTolerance);
  ASSERT_FALSE(match);
  EXPECT_EQ(match.error().text,
            "no choice of measured points keeps the distances of marker 4 to those before it "
            "within 3 mm");
}

TEST_F(MarkerMatching, RefusesWhatCannotBeMatched) {
  const auto refusal = [](const Points& planned, const Points& measured, double tolerance) {
    const auto match = match_markers(planned, measured, tolerance);
    return match ? "" : match.error().text;
  };
  Points wrong = head();
  wrong[4].z() = NAN;
  EXPECT_EQ(refusal(first(2), head(), kTolerance), "2 markers, at least 3 are needed");
  EXPECT_EQ(refusal(head(), first(5), kTolerance), "6 markers are planned, 5 points measured");
  EXPECT_EQ(refusal(wrong, head(), kTolerance), "planned marker 5 is not finite");
  EXPECT_EQ(refusal(head(), wrong, kTolerance), "measured point 5 is not finite");
  EXPECT_EQ(refusal(head(), head(), -1), "the tolerance is -1 m");
  EXPECT_EQ(refusal(head(), head(), NAN), "the tolerance is nan m");
}

/// Four markers lie among 40 points in 2193360 ways, each of which wants two fits.
TEST_F(MarkerMatching, EndsSoonWhateverTheToleranceIs) {
  for (const auto& [planned, measured] : {std::pair{4u, 40u}, std::pair{64u, 64u}}) {
    SCOPED_TRACE(planned);
    Points points;
    for (unsigned i = 0; i < measured; ++i) {
      points.emplace_back(normal_(random_), normal_(random_), normal_(random_));
    }
    const std::clock_t begun = std::clock();
    const auto match = match_markers(std::span{points}.first(planned), points, 1e3);
    const double took_s = static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
    ASSERT_FALSE(match);
    EXPECT_NE(match.error().text.find("lower the tolerance"), std::string::npos);
    EXPECT_LT(took_s, 1) << "of the processor's time";
  }
}

TEST_F(MarkerMatching, EndsAlsoWhereEverythingLooksAlike) {
  const Points cloud(12, Eigen::Vector3d{1, 2, 3});
  const auto match = match_markers(cloud, cloud, kTolerance);
  ASSERT_FALSE(match);
  EXPECT_EQ(match.error().text,
            "too many ways to match 12 markers with 12 points within 3 mm: lower the tolerance");
}

}  // namespace
}  // namespace armature
