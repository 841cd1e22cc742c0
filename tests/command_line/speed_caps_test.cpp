// SPDX-License-Identifier: Apache-2.0
// What a task asks of an arm's tip, beside what the motion of that arm lets the tip do: its speed,
// and how near it comes to an incision.
#include <gmock/gmock.h>

#include "command.hpp"

namespace armature::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kTipSpeed = "components.task.params.max_tip_speed_m_s";
const std::string kTrackingSpeed = "components.motion.params.max_tracking_velocity_m_s";

CommandResult check_leader(const std::vector<std::string>& settings) {
  std::vector<std::string> words{armature(), "check",
                                 source_file("configs/master_manipulator.yaml")};
  for (const std::string& setting : settings) words.insert(words.end(), {"--set", setting});
  return run_command(words);
}

TEST(SpeedCaps, ATipThatIsAskedToBeFasterThanItsMotionIsRefusedWithBothPlaces) {
  const CommandResult result = check_leader({kTipSpeed + "=0.2"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err,
              AllOf(StartsWith("--set " + kTipSpeed + "=0.2: 'max_tip_speed_m_s' of component "),
                    HasSubstr("'task' is 0.2 ("),
                    HasSubstr("above 'max_tracking_velocity_m_s' of component 'motion', which is "
                              "0.049 ("),
                    HasSubstr("configs/master_manipulator.yaml:33:"),
                    HasSubstr("): the follower would trail behind its target; lower the first or "
                              "raise the second\n")));
  EXPECT_EQ(result.err.find('\n'), result.err.size() - 1) << "it is said once: " << result.err;
}

TEST(SpeedCaps, BothTogetherOrNoneOfTheMotionPassTheCheck) {
  EXPECT_EQ(check_leader({kTipSpeed + "=0.2", kTrackingSpeed + "=0.2"}).exit_code, 0);
  const CommandResult any = check_leader({kTipSpeed + "=0.2", kTrackingSpeed + "=0"});
  EXPECT_EQ(any.exit_code, 0) << any.err;
}

const std::string kTaskDepth = "components.task.params.min_depth_mm";

TEST(MinDepth, OfATaskThatIsNotThatOfItsFollowersMotionIsRefusedWhereItStands) {
  const CommandResult result = check_leader({kTaskDepth + "=5"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.err, "--set " + kTaskDepth +
                            "=5: 'min_depth_mm' of component 'task' must be the same as that of "
                            "component 'motion', and is not; leave one of them out, or make them "
                            "equal\n");
}

TEST(MinDepth, IsSaidOnceByTheMotionOrTwiceTheSameAndThatOfTheLeaderIsItsOwn) {
  const std::string motion = "components.motion.params.min_depth_mm=5";
  EXPECT_EQ(check_leader({motion}).exit_code, 0);
  EXPECT_EQ(check_leader({motion, kTaskDepth + "=5"}).exit_code, 0);
  const CommandResult of_leader = check_leader({"components.leader_motion.params.min_depth_mm=5"});
  EXPECT_EQ(of_leader.exit_code, 0) << of_leader.err;
}

}  // namespace
}  // namespace armature::test
