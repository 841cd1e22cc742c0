// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/kinematics/singular_values.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace armature {
namespace {

SmallMatrix random_matrix(int rows, int columns) {
  std::mt19937_64 random{static_cast<std::uint64_t>(rows * 100 + columns)};
  std::normal_distribution<double> normal;
  SmallMatrix matrix(rows, columns);
  for (double& x : matrix.reshaped()) x = normal(random);
  return matrix;
}

TEST(SingularValues, GiveTheMatrixBackWhateverItsShape) {
  for (const auto& [rows, columns] : {std::pair{6, 7}, {7, 6}, {1, 1}, {12, 12}, {5, 1}, {1, 12}}) {
    const SmallMatrix matrix = random_matrix(rows, columns);
    const SingularValues svd{matrix};
    SmallMatrix again = svd.left;
    for (int i = 0; i < svd.values.size(); ++i) again.col(i) *= svd.values[i];
    again = SmallMatrix{again.lazyProduct(svd.right.transpose())};
    EXPECT_LT((again.topLeftCorner(rows, columns) - matrix).cwiseAbs().maxCoeff(), 1e-13)
        << rows << " x " << columns;
    for (int i = 1; i < svd.values.size(); ++i) EXPECT_GE(svd.values[i - 1], svd.values[i]);
  }
}

TEST(SingularValues, SeeHowNearAMatrixIsToSingularToTheLastDigit) {
  SmallMatrix matrix(6, 7);
  matrix.setZero();
  matrix.diagonal() << 1, 1, 1, 1, 1, 1e-13;
  EXPECT_NEAR(smallest_singular_value(matrix), 1e-13, 1e-28);
  EXPECT_NEAR(smallest_singular_value(matrix.transpose()), 1e-13, 1e-28);
  matrix(5, 5) = 0;
  EXPECT_EQ(smallest_singular_value(matrix), 0);
}

TEST(SingularValues, TheSmallestAloneIsThatOfTheDecomposition) {
  for (const auto& [rows, columns] : {std::pair{6, 7}, {7, 6}, {6, 6}, {1, 1}, {12, 12}, {5, 1}}) {
    const SmallMatrix matrix = random_matrix(rows, columns);
    const double smallest = SingularValues{matrix}.values[std::min(rows, columns) - 1];
    EXPECT_NEAR(smallest_singular_value(matrix), smallest, 1e-14) << rows << " x " << columns;
  }
}

TEST(SingularValues, AColumnThatRepeatsMakesTheSmallestOneNothing) {
  SmallMatrix matrix = random_matrix(6, 6);
  matrix.col(4) = 3 * matrix.col(1);
  EXPECT_LT(smallest_singular_value(matrix), 1e-15);
  EXPECT_LT(smallest_singular_value(matrix.transpose()), 1e-15);
}

TEST(ShortestSolution, IsTheSolutionWithoutWhatChangesNothing) {
  const SmallMatrix matrix = random_matrix(6, 7);
  const SmallVector right = random_matrix(6, 1);
  const SmallVector x = shortest_solution(matrix, right);
  ASSERT_EQ(x.size(), 7);
  EXPECT_LT((matrix.lazyProduct(x) - right).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_NEAR(x.dot(SingularValues{matrix}.right.col(6)), 0, 1e-14) << "the self-motion";
}

TEST(ShortestSolution, OfASingularMatrixLeavesOutWhatItCannotReach) {
  SmallMatrix matrix = SmallMatrix::Zero(2, 3);
  matrix(0, 0) = 2;
  matrix(1, 0) = 1e-17;
  SmallVector right(2);
  right << 4, 1;
  const SmallVector x = shortest_solution(matrix, right);
  EXPECT_NEAR(x[0], 2, 1e-15);
  EXPECT_EQ(x[1], 0);
  EXPECT_EQ(x[2], 0);
}

}  // namespace
}  // namespace armature
