// SPDX-License-Identifier: Apache-2.0
// Whether an implant is turned as it goes in.
#include "thread_watch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace armature::task::implant {
namespace {

using Eigen::Vector3d;

constexpr double kTurn = 2 * std::numbers::pi;
const Thread kThread{.start = {0.3, 0, 0.5}, .axis = -Vector3d::UnitZ(), .pitch_m = 0.001};

Time at(double s) { return Time{} + seconds(s); }
Vector3d along(double advance_m) { return kThread.start + advance_m * kThread.axis; }

class ThreadWatchTest : public testing::Test {
 protected:
  ThreadWatchTest() {
    watch_.see(100, at(1));
    watch_.engage(kThread, at(1));
  }
  ThreadWatch watch_{{.timeout = 0.5, .max_thread_error = 0.0002}};
};

TEST_F(ThreadWatchTest, ATurnForEveryPitchIsAsTheThreadWants) {
  watch_.see(100 + 3.1 * kTurn, at(1.4));
  EXPECT_EQ(watch_.trouble(along(0.003), at(1.4)), std::nullopt);
  EXPECT_EQ(watch_.trouble(along(0.00325), at(1.4)), std::nullopt);
  EXPECT_NE(watch_.trouble(along(0.0035), at(1.4)), std::nullopt) << "pushed";
  EXPECT_NE(watch_.trouble(along(0.0027), at(1.4)), std::nullopt) << "turned without going in";
}

TEST_F(ThreadWatchTest, BeforeTheThreadBeginsNothingIsWanted) {
  EXPECT_EQ(watch_.trouble(along(-0.02), at(1.4)), std::nullopt);
}

TEST_F(ThreadWatchTest, TellsBothInMillimetresAndTurns) {
  watch_.see(100 + 0.5 * kTurn, at(1.4));
  EXPECT_EQ(watch_.trouble(along(0.002), at(1.4)),
            "the implant went in by 2.00 mm, and was turned by 0.50 of the 2.00 turns that its "
            "thread wants; 0.2 mm off are allowed");
}

TEST_F(ThreadWatchTest, AnAngleThatIsNoneIsTrouble) {
  watch_.see(NAN, at(1.4));
  EXPECT_EQ(watch_.trouble(along(0), at(1.4)),
            "what the handpiece tells of how far it has turned is no number: nan rad");
}

TEST_F(ThreadWatchTest, AnAngleThatIsNoneWhenTheImplantBeginsToGoInIsTroubleToo) {
  watch_.see(INFINITY, at(1));
  watch_.engage(kThread, at(1));
  EXPECT_EQ(watch_.trouble(along(0), at(1.4)),
            "what the handpiece tells of how far it has turned is no number: inf rad");
  watch_.see(100, at(1.4));
  EXPECT_NE(watch_.trouble(along(0), at(1.4)), std::nullopt) << "turned from where is not known";
}

TEST_F(ThreadWatchTest, AHandpieceThatIsSilentIsTrouble) {
  EXPECT_EQ(watch_.trouble(along(0), at(1.5)), std::nullopt);
  EXPECT_EQ(watch_.trouble(along(0), at(1.6)),
            "the handpiece has not told for 0.60 s how far it has turned");
  watch_.release();
  EXPECT_EQ(watch_.trouble(along(0.5), at(9)), std::nullopt) << "nothing is in a thread";
}

}  // namespace
}  // namespace armature::task::implant
