// SPDX-License-Identifier: Apache-2.0
#include "trajectory_hash.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace armature::report::lamp_alignment {
namespace {

TEST(TrajectoryHash, OfNothingIsThatOfTheEmptyText) {
  EXPECT_EQ(TrajectoryHash{}.hex(),
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST(TrajectoryHash, IsSha256OverNanosecondsAndDoubles) {
  // python3: hashlib.sha256(struct.pack('<q6d', 1000000, 1, 2, 3, 4, 5, 6)).hexdigest()
  TrajectoryHash hash;
  hash.add(Time{1'000'000}, std::array<double, 6>{1, 2, 3, 4, 5, 6});
  EXPECT_EQ(hash.hex(), "75fc6c9cd4d330476b0abad692e6dc41304fc37c5f84fb6926bae61f50b4e524");
}

TEST(TrajectoryHash, ChangesWithTheLastBitOfOneSample) {
  TrajectoryHash one, other;
  one.add(Time{1}, std::array<double, 1>{1.0});
  other.add(Time{1}, std::array<double, 1>{std::nextafter(1.0, 2.0)});
  EXPECT_NE(one.hex(), other.hex());
}

}  // namespace
}  // namespace armature::report::lamp_alignment
