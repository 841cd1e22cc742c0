// SPDX-License-Identifier: Apache-2.0
// Boards that a bent lens sees from all sides: 1. every corner is found where it is, in the board's
// own order, 2. what is no whole board is refused.
#include "chessboard.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "armature/robot/geometry/rotation.hpp"
#include "rendered_board_test.hpp"

namespace armature::chessboard {
namespace {

constexpr int kAcross = 640, kDown = 480;
constexpr double kSquare = 0.025;
const BoardShape kBoard{.columns = 9, .rows = 6};
const stereo::Lens kLens{.fx = 520,
                         .fy = 523,
                         .cx = 316,
                         .cy = 236,
                         .distortion = {-0.22, 0.07, 0.0012, -0.0008, -0.004}};

/// The board's middle at `middle`, turned by roll, pitch and yaw.
Eigen::Isometry3d board_at(const Eigen::Vector3d& middle, const Eigen::Vector3d& rpy,
                           const BoardShape& shape = kBoard) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = rotation_from_rpy(rpy);
  pose.translation() =
      middle - pose.linear() * Eigen::Vector3d{0.5 * kSquare * (shape.columns - 1),
                                               0.5 * kSquare * (shape.rows - 1), 0};
  return pose;
}

const BoardCamera& camera() {
  static const BoardCamera made{kLens, kAcross, kDown};
  return made;
}

/// How far the corners are from where they are: rms and the worst [px].
struct Errors {
  double rms, worst;
};
Errors errors(const std::vector<Eigen::Vector2d>& found,
              const std::vector<Eigen::Vector2d>& expected) {
  Errors errors{0, 0};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const double off = (found[i] - expected[i]).norm();
    errors.rms += off * off / static_cast<double>(expected.size());
    errors.worst = std::max(errors.worst, off);
  }
  errors.rms = std::sqrt(errors.rms);
  return errors;
}

TEST(Chessboard, EveryCornerIsFoundWhereItIsInTheBoardsOwnOrder) {
  constexpr std::uint64_t kSeed = 5;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 random{kSeed};
  std::uniform_real_distribution<double> unit{-1, 1};
  for (int i = 0; i < 10; ++i) {
    const Eigen::Isometry3d pose =
        board_at({0.05 * unit(random), 0.04 * unit(random), 0.42 + 0.1 * unit(random)},
                 {0.5 * unit(random), 0.5 * unit(random), 3.1 * unit(random)});
    const auto expected = camera().corners(pose, kBoard, kSquare);
    const auto found =
        find_board(camera().picture(pose, kBoard, kSquare, 3, kSeed), kAcross, kDown, kBoard);
    ASSERT_TRUE(found) << "board " << i << ": " << found.error().text;
    ASSERT_EQ(found->size(), expected.size());
    const Errors off = errors(*found, expected);
    EXPECT_LT(off.rms, 0.1) << "board " << i << ", with noise of 3 grey values";
    EXPECT_LT(off.worst, 0.4) << "board " << i;
  }
}

TEST(Chessboard, WhoseCountsAreBothEvenBeginsAtTheUpperLeft) {
  const BoardShape even{.columns = 8, .rows = 6};
  for (const double yaw : {0.3, 3.0, -1.2}) {
    const Eigen::Isometry3d pose = board_at({0, 0, 0.4}, {0.2, -0.3, yaw}, even);
    const auto found =
        find_board(camera().picture(pose, even, kSquare, 2, 1), kAcross, kDown, even);
    ASSERT_TRUE(found) << found.error().text;
    auto expected = camera().corners(pose, even, kSquare);
    if (expected.back().sum() < expected.front().sum()) std::ranges::reverse(expected);
    EXPECT_LT(errors(*found, expected).worst, 0.25) << "yaw " << yaw;
  }
}

TEST(Chessboard, WhoseSidesAreEqualHasTheRowsThatAreNearestToThePicturesRows) {
  for (const BoardShape& equal : {BoardShape{7, 7}, BoardShape{6, 6}}) {
    for (const double yaw : {-1.9, -0.4, 1.2, 3.0}) {
      SCOPED_TRACE(std::to_string(equal.columns) + " a side, yaw " + std::to_string(yaw));
      const Eigen::Isometry3d pose = board_at({0, 0, 0.42}, {0.2, -0.3, yaw}, equal);
      const auto found =
          find_board(camera().picture(pose, equal, kSquare, 2, 1), kAcross, kDown, equal);
      ASSERT_TRUE(found) << found.error().text;
      // The same board, seen by a camera that is turned by as many quarters.
      const double quarters = std::round(yaw / (0.5 * std::numbers::pi));
      Eigen::Isometry3d counted = pose;
      const double side = kSquare * (equal.columns - 1);
      const Eigen::Vector3d middle = pose * Eigen::Vector3d{0.5 * side, 0.5 * side, 0};
      counted.linear() =
          pose.linear() * rotation_from_rpy({0, 0, -0.5 * std::numbers::pi * quarters});
      counted.translation() =
          middle - counted.linear() * Eigen::Vector3d{0.5 * side, 0.5 * side, 0};
      EXPECT_LT(errors(*found, camera().corners(counted, equal, kSquare)).worst, 0.3);
    }
  }
}

TEST(Chessboard, ThatDoesNotTellItsBeginningIsCountedAsInAnotherView) {
  // Half way between two ways to count a small turn would decide; the other view does.
  for (const auto& [shape, yaw] :
       {std::pair{BoardShape{7, 7}, -0.79}, {BoardShape{6, 6}, 2.36}, {BoardShape{8, 6}, 1.73}}) {
    SCOPED_TRACE(std::to_string(shape.columns) + " columns, yaw " + std::to_string(yaw));
    const auto seen = [&](double turn, const Eigen::Vector2d& towards) {
      const Eigen::Isometry3d pose = board_at({0, 0, 0.42}, {0.1, -0.2, turn}, shape);
      return find_board(camera().picture(pose, shape, kSquare, 2, 1), kAcross, kDown, shape,
                        towards);
    };
    const auto first = seen(yaw - 0.15, {1, 1});
    ASSERT_TRUE(first) << first.error().text;
    const auto second = seen(yaw + 0.15, first->back() - first->front());
    ASSERT_TRUE(second) << second.error().text;
    const double turned = 0.3 * 0.5 * (first->back() - first->front()).norm();  // the outermost
    EXPECT_LT(errors(*first, *second).worst, 1.5 * turned) << "by another way to count, 4.7 times";
  }
}

TEST(Chessboard, ThatIsNotWholeIsRefusedWithWhatIsSeen) {
  const Eigen::Isometry3d beside = board_at({0.2, 0, 0.4}, {0, 0, 0});
  const auto cut =
      find_board(camera().picture(beside, kBoard, kSquare, 2, 1), kAcross, kDown, kBoard);
  ASSERT_FALSE(cut);
  EXPECT_NE(
      cut.error().text.find("54 corners are asked for, 9 x 6; the largest grid that is seen has "),
      std::string::npos)
      << cut.error().text;
  const Eigen::Isometry3d whole = board_at({0, 0, 0.4}, {0, 0, 0});
  const auto other =
      find_board(camera().picture(whole, kBoard, kSquare, 2, 1), kAcross, kDown, {7, 6});
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().text,
            "42 corners are asked for, 7 x 6; the largest grid that is seen has 54, 9 x 6");
  for (const int grey : {0, 128}) {
    const std::vector<std::uint8_t> empty(kAcross * kDown, static_cast<std::uint8_t>(grey));
    EXPECT_FALSE(find_board(empty, kAcross, kDown, kBoard));
  }
  std::mt19937_64 random{1};
  std::vector<std::uint8_t> noise(kAcross * kDown);
  for (auto& pixel : noise) pixel = static_cast<std::uint8_t>(random());
  EXPECT_FALSE(find_board(noise, kAcross, kDown, kBoard));
}

}  // namespace
}  // namespace armature::chessboard
