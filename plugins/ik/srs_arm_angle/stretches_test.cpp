// SPDX-License-Identifier: Apache-2.0
#include "stretches.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace armature {
namespace {

class StretchesTest : public testing::Test {
 protected:
  /// Forty regular places and pi.
  StretchesTest() {
    table_->regular = 40;
    table_->sorted = table_->count = 41;
    for (int i = 0; i <= 40; ++i) table_->place[i] = -M_PI + M_PI / 20 * i;
  }
  void add(std::initializer_list<Span> list) {
    Spans spans;
    for (const Span& span : list) spans.add(span);
    stretches_->add(5, spans);
  }
  std::size_t count() const {
    return static_cast<std::size_t>(stretches_->end() - stretches_->begin());
  }
  const Stretch& at(std::size_t i) const { return stretches_->begin()[i]; }

  std::unique_ptr<CostTable> table_ = std::make_unique<CostTable>();
  std::unique_ptr<Stretches> stretches_ = std::make_unique<Stretches>(*table_);
};

TEST_F(StretchesTest, ASpanHasThePlacesWithinIt) {
  add({{-1, 1}});
  ASSERT_EQ(count(), 1U);
  EXPECT_EQ(at(0).branch, 5U);
  EXPECT_GE(table_->place[at(0).first], -1);
  EXPECT_LT(table_->place[at(0).first - 1], -1);
  EXPECT_LE(table_->place[at(0).end - 1], 1);
  EXPECT_GT(table_->place[at(0).end], 1);
  EXPECT_FALSE(at(0).cut_below || at(0).cut_above);
  EXPECT_EQ(table_->count, 41);
}

TEST_F(StretchesTest, ASpanAcrossPiIsTwoStretchesThatKnowAllOfIt) {
  add({{-M_PI, -2}, {-1, 1}, {2, M_PI}});
  ASSERT_EQ(count(), 3U);
  EXPECT_EQ(at(0).first, 0);
  EXPECT_TRUE(at(0).cut_below);
  EXPECT_FALSE(at(0).cut_above);
  EXPECT_EQ(at(0).span.lower, 2 - 2 * M_PI);
  EXPECT_EQ(at(0).span.upper, -2);
  EXPECT_EQ(at(1).end, 41);
  EXPECT_TRUE(at(1).cut_above);
  EXPECT_FALSE(at(1).cut_below);
  EXPECT_EQ(at(1).span.lower, 2);
  EXPECT_EQ(at(1).span.upper, -2 + 2 * M_PI);
}

TEST_F(StretchesTest, TheWholeTurnHasNoEnds) {
  add({{-M_PI, M_PI}});
  ASSERT_EQ(count(), 1U);
  EXPECT_TRUE(at(0).cut_below && at(0).cut_above);
  EXPECT_EQ(at(0).first, 0);
  EXPECT_EQ(at(0).end, 41);
}

TEST_F(StretchesTest, APointAtOneSideOfPiIsThatAtTheOther) {
  for (const bool below : {true, false}) {
    stretches_ = std::make_unique<Stretches>(*table_);
    if (below) {
      add({{-M_PI, -M_PI}, {2, M_PI}});
    } else {
      add({{-M_PI, -2}, {M_PI, M_PI}});
    }
    ASSERT_EQ(count(), 1U);
    EXPECT_FALSE(at(0).cut_below || at(0).cut_above);
    EXPECT_EQ(at(0).span.lower, below ? 2 : -M_PI);
    EXPECT_EQ(at(0).span.upper, below ? M_PI : -2);
  }
}

TEST_F(StretchesTest, ANarrowSpanGetsPlacesOfItsOwn) {
  add({{0.01, 0.05}});
  EXPECT_EQ(table_->count, 44);
  EXPECT_EQ(at(0).first, 41);
  EXPECT_EQ(at(0).end, 44);
  EXPECT_NEAR(table_->place[42], 0.03, 1e-15);
}

TEST_F(StretchesTest, ANarrowSpanAcrossPiIsOne) {
  add({{-M_PI, -3.13}, {3.13, M_PI}});
  ASSERT_EQ(count(), 1U);
  EXPECT_NEAR(table_->place[42], M_PI, 1e-15);
}

TEST_F(StretchesTest, ATinySpanAndAPointHaveTheirEndsAlone) {
  add({{0.01, 0.0109}, {0.02, 0.02}});
  ASSERT_EQ(count(), 2U);
  EXPECT_EQ(at(0).first, at(0).end);
  EXPECT_EQ(at(1).first, at(1).end);
  EXPECT_EQ(table_->count, 41);
}

}  // namespace
}  // namespace armature
