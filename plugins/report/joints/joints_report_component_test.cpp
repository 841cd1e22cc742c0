// SPDX-License-Identifier: Apache-2.0
// The joint report on its topics: 1. its rows, 2. what it does not know, 3. what it writes and
// where, 4. a disk that is full.
#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>

#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/tool_pose_messages.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/header.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"
#include "armature/values/file_content.hpp"
#include "armature/values/temporary_folder.hpp"

namespace armature::report::joints {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using testing::HasSubstr;

const std::string kRobotFile = ARMATURE_SOURCE_DIR "/configs/robots/sr1_needle.yaml";
constexpr std::uint8_t kTracking = 1, kHold = 2, kExecuting = 1, kFailed = 4;
constexpr double kPeriod_s = 0.02;  // of the report's steps

using Row = std::map<std::string, std::string>;

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream text{line + ','};
  for (std::string field; std::getline(text, field, ',');) fields.push_back(field);
  return fields;
}

/// The rows of a table under the names of its columns; every line must end with CR LF.
std::vector<Row> rows_in(const fs::path& file) {
  const std::string text = content_of(file);
  EXPECT_TRUE(text.ends_with("\r\n"));
  std::istringstream lines{text};
  std::string line;
  const auto next = [&] {
    const bool there = static_cast<bool>(std::getline(lines, line));
    if (there) line.pop_back();
    return there;
  };
  EXPECT_TRUE(next());
  const auto names = fields_of(line);
  std::vector<Row> rows;
  while (next()) {
    const auto fields = fields_of(line);
    EXPECT_EQ(fields.size(), names.size()) << line;
    Row& row = rows.emplace_back();
    for (std::size_t i = 0; i < fields.size(); ++i) row[names[i]] = fields[i];
  }
  return rows;
}

double number(const Row& row, const std::string& column) { return std::stod(row.at(column)); }

class JointsReportTest : public testing::Test {
 protected:
  ComponentHarness bench(const std::string& more = "") const {
    return {built_plugins(),
            {.component = "{plugin: report/joints, params: {file: " + stem() + more + "}}",
             .robot = config::load(kRobotFile)}};
  }
  std::string stem() const { return folder_ / "arm_joints"; }
  std::string csv() const { return stem() + ".csv"; }
  std::string svg() const { return stem() + ".svg"; }

  msg::JointState state(double t, const JointVector& q, const JointVector& v) const {
    msg::JointState message;
    write_all_joints(model_, q, v, Time{} + seconds(t), message);
    return message;
  }
  /// Where the reference is; the arm lags behind by `kLag` seconds.
  JointVector reference(double t) const { return home_ + 0.1 * t * JointVector::Ones(6); }
  JointVector measured(double t) const { return reference(t - kLag); }
  const JointVector rate_ = 0.1 * JointVector::Ones(6);
  static constexpr double kLag = 0.03;

  /// A millisecond of reference and arm, as long as it is told.
  void run(ComponentHarness& report, int from_ms, int to_ms, bool with_reference = true) const {
    for (int ms = from_ms; ms < to_ms; ++ms) {
      const double t = 0.001 * ms;
      if (with_reference) report.send("servo_jp", state(t, reference(t), rate_));
      report.send("measured_js", state(t, measured(t), rate_));
      if (ms % 20 == 0) report.step(t);
    }
  }
  static void tell_goal(ComponentHarness& report, double t, std::uint64_t id, std::uint8_t mode,
                        const ToolPose& pose, const Vector3d& velocity = Vector3d::Zero()) {
    msg::MotionGoal goal;
    write_header(goal.header_(), Time{} + seconds(t), kBaseFrame);
    goal.goal_id_(id);
    goal.mode_(mode);
    write_tool_pose(pose, goal);
    assign(goal.velocity_(), velocity);
    report.send("goal", goal);
  }
  static void tell_status(ComponentHarness& report, double t, std::uint64_t id,
                          std::uint8_t state) {
    msg::MotionStatus status;
    write_header(status.header_(), Time{} + seconds(t), kBaseFrame);
    status.goal_id_(id);
    status.state_(state);
    report.send("status", status);
  }

  const RobotModel model_ = load_robot_model(kRobotFile);
  const JointVector home_ = *model_.to_independent(*model_.home());
  const TemporaryFolder folder_;
};

// 1.

TEST_F(JointsReportTest, TellsAHundredTimesASecondWhereEveryJointIsAndHowFarFromTheReference) {
  auto report = bench();
  run(report, 0, 1001);
  const auto rows = rows_in(csv());
  ASSERT_EQ(rows.size(), 101u);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double t = 0.01 * static_cast<double>(i);
    EXPECT_NEAR(number(rows[i], "time_s"), t, 1e-9);
    EXPECT_NEAR(number(rows[i], "stamp_s"), t, 1e-9);
    EXPECT_NEAR(number(rows[i], "j1_rad"), measured(t)[0], 1e-8);
    EXPECT_NEAR(number(rows[i], "needle_m"), measured(t)[5], 1e-8);
    EXPECT_NEAR(number(rows[i], "j2_rad_s"), 0.1, 1e-8);
    EXPECT_NEAR(number(rows[i], "needle_m_s"), 0.1, 1e-8);
    EXPECT_NEAR(number(rows[i], "j1_reference_rad"), reference(t)[0], 1e-8);
    EXPECT_NEAR(number(rows[i], "j1_error_rad"), -0.1 * kLag, 1e-8);
    EXPECT_NEAR(number(rows[i], "needle_error_m"), -0.1 * kLag, 1e-8);
  }
}

TEST_F(JointsReportTest, TheReferenceIsThatOfTheInstantAtWhichTheArmWasMeasured) {
  auto report = bench();
  report.step(0);
  report.send("servo_jp", state(0.010, reference(0.010), rate_));
  report.send("measured_js", state(0.014, reference(0.014), rate_));
  report.send("servo_jp", state(0.015, reference(0.5), rate_));  // later: not meant
  report.step(kPeriod_s);
  const auto rows = rows_in(csv());
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_NEAR(number(rows[0], "j1_error_rad"), 0, 1e-9);
}

TEST_F(JointsReportTest, TellsHowFarTheToolIsFromTheGoal) {
  auto report = bench();
  const Eigen::Isometry3d tool = forward_kinematics(model_, measured(0.1));
  const Eigen::Quaterniond turned{tool.linear() *
                                  Eigen::AngleAxisd{0.2, Vector3d::UnitY()}.toRotationMatrix()};
  tell_goal(report, 0.1, 12, 0,
            {.position = tool.translation() + Vector3d{0, 0.003, 0.004}, .orientation = turned});
  run(report, 0, 101);
  const auto rows = rows_in(csv());
  ASSERT_EQ(rows.size(), 11u);
  EXPECT_EQ(rows[9].at("goal_id"), "") << "it comes later";
  EXPECT_EQ(rows[10].at("goal_id"), "12");
  EXPECT_NEAR(number(rows[10], "goal_position_error_m"), 0.005, 1e-8);
  EXPECT_NEAR(number(rows[10], "goal_orientation_error_rad"), 0.2, 1e-8);
}

TEST_F(JointsReportTest, ATargetThatMovesIsWhereItIsByNow) {
  auto report = bench();
  const ToolPose pose{.position = forward_kinematics(model_, home_).translation()};
  tell_goal(report, 0, 1, kTracking, pose, {0, 0, 0.5});
  report.step(0);
  report.send("measured_js", state(0.02, home_, rate_));
  report.step(kPeriod_s);
  EXPECT_NEAR(number(rows_in(csv()).at(0), "goal_position_error_m"), 0.01, 1e-8);
}

TEST_F(JointsReportTest, AnArmThatIsSlowerThanTheTableHasARowForEverySample) {
  auto report = bench(", rate_hz: 1000");
  report.step(0);
  for (const double t : {0.003, 0.011, 0.016}) {
    report.send("measured_js", state(t, home_, rate_));
  }
  report.step(kPeriod_s);
  EXPECT_EQ(rows_in(csv()).size(), 3u);
}

// 2.

TEST_F(JointsReportTest, WithoutAReferenceAndAGoalTheseFieldsAreEmpty) {
  auto report = bench();
  run(report, 0, 21, false);
  const auto rows = rows_in(csv());
  ASSERT_EQ(rows.size(), 3u);
  for (const char* column : {"j1_reference_rad", "j1_error_rad", "needle_error_m", "goal_id",
                             "goal_position_error_m", "goal_orientation_error_rad"}) {
    EXPECT_EQ(rows[2].at(column), "") << column;
  }
  EXPECT_NE(rows[2].at("j1_rad"), "");
}

TEST_F(JointsReportTest, AReferenceThatHasFallenSilentIsNone) {
  auto report = bench();
  run(report, 0, 101);
  run(report, 101, 301, false);
  const auto rows = rows_in(csv());
  EXPECT_NE(rows[15].at("j1_reference_rad"), "");
  EXPECT_EQ(rows[25].at("j1_reference_rad"), "");
}

TEST_F(JointsReportTest, AGoalThatFailedAndAnArmThatHoldsHaveNoError) {
  auto report = bench();
  const ToolPose pose{.position = {1, 0, 0}};
  tell_goal(report, 0.00, 1, 0, pose);
  tell_status(report, 0.00, 1, kExecuting);
  tell_status(report, 0.05, 1, kFailed);
  run(report, 0, 101);
  tell_goal(report, 0.10, 2, 0, pose);
  tell_status(report, 0.101, 2, kExecuting);
  run(report, 101, 151);
  tell_goal(report, 0.15, 3, kHold, pose);
  tell_status(report, 0.151, 3, kExecuting);
  run(report, 151, 201);
  const auto rows = rows_in(csv());
  ASSERT_EQ(rows.size(), 21u);
  const auto id_at = [&](std::size_t row) { return rows[row].at("goal_id"); };
  EXPECT_EQ(id_at(4), "1");
  EXPECT_EQ(id_at(5), "");
  EXPECT_EQ(id_at(11), "2");
  EXPECT_EQ(id_at(16), "");
}

TEST_F(JointsReportTest, AnArmThatRefusesAStreamOfGoalsHasNone) {
  auto report = bench();
  tell_goal(report, 0, 1, kTracking, {.position = {1, 0, 0}});
  tell_status(report, 0, 1, kExecuting);
  run(report, 0, 50);
  for (int ms = 50; ms < 101; ++ms) {
    const std::uint64_t id = static_cast<std::uint64_t>(ms);
    tell_goal(report, 0.001 * ms, id, kTracking, {.position = {1, 0, 0}});
    tell_status(report, 0.001 * ms, id - 1, kFailed);  // of the one before
    run(report, ms, ms + 1);
  }
  const auto rows = rows_in(csv());
  EXPECT_EQ(rows.at(4).at("goal_id"), "1");
  EXPECT_EQ(rows.at(10).at("goal_id"), "");
}

TEST_F(JointsReportTest, ARunThatIsStoppingGoesToNoGoalAnyMore) {
  auto report = bench();
  tell_goal(report, 0, 1, 0, {.position = {1, 0, 0}});
  run(report, 0, 101);
  report.begin_stop(0.1);
  run(report, 101, 201);
  const auto rows = rows_in(csv());
  EXPECT_EQ(rows.at(10).at("goal_id"), "1");
  EXPECT_EQ(rows.at(11).at("goal_id"), "");
  EXPECT_NE(rows.at(20).at("j1_rad"), "") << "its joints are told to the end";
}

TEST_F(JointsReportTest, ASampleThatIsNoStateOfTheArmIsToldAndLeftOut) {
  auto report = bench();
  report.step(0);
  msg::JointState broken = state(0.01, home_, rate_);
  broken.position_().pop_back();
  report.send("measured_js", broken);
  report.step(0.02);
  EXPECT_EQ(report.status().state, StatusReporter::State::degraded);
  EXPECT_THAT(report.status().reason, HasSubstr("measured_js"));
  report.send("measured_js", state(0.03, home_, rate_));
  report.step(0.04);
  EXPECT_EQ(report.status().state, StatusReporter::State::ok);
  EXPECT_EQ(rows_in(csv()).size(), 1u);
}

// 3.

TEST_F(JointsReportTest, ThePictureIsWrittenAtTheEndAndAnOlderOneGoesAtTheStart) {
  std::ofstream{svg()} << "of an older run";
  auto report = bench();
  EXPECT_FALSE(fs::exists(svg()));
  run(report, 0, 101);
  report.component().write_files(folder_.path());
  const std::string picture = content_of(svg());
  for (const char* title : {">joint position [rad]<", ">joint position [m]<", ">joint speed [m/s]<",
                            ">joint error, measured - reference [rad]<"}) {
    EXPECT_THAT(picture, HasSubstr(title));
  }
  EXPECT_EQ(fs::status(svg()).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(JointsReportTest, WithoutAFileItWritesNothingAndIsNeverActivated) {
  ComponentHarness report{
      built_plugins(), {.component = "{plugin: report/joints}", .robot = config::load(kRobotFile)}};
  EXPECT_FALSE(report.period());
  run(report, 0, 41);
  report.component().write_files(folder_.path());
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(JointsReportTest, AFolderThatIsNotThereIsRefusedBeforeAnythingMoves) {
  fs::remove_all(folder_.path());
  const std::string refused = refusal_of(
      built_plugins(), {.component = "{plugin: report/joints, params: {file: " + stem() + "}}",
                        .robot = config::load(kRobotFile)});
  EXPECT_THAT(refused, HasSubstr("cannot write '" + csv() + "': No such file or directory"));
}

// 4.

TEST_F(JointsReportTest, AFullDiskIsToldOnceWithTheFileAndTheRowsBeforeItAreWhole) {
  auto report = bench();
  run(report, 0, 201);
  const auto before = rows_in(csv());
  rlimit unlimited{};
  getrlimit(RLIMIT_FSIZE, &unlimited);
  const rlimit full{fs::file_size(csv()) + 100, unlimited.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &full);
  run(report, 201, 1001);
  setrlimit(RLIMIT_FSIZE, &unlimited);
  std::signal(SIGXFSZ, handler);
  run(report, 1001, 1201);
  const auto names_it = [&](const std::string& line) {
    return line.find("cannot write '" + csv() + "': File too large") != std::string::npos;
  };
  EXPECT_EQ(std::ranges::count_if(report.lines(), names_it), 1);
  EXPECT_EQ(rows_in(csv()), before);
  EXPECT_THROW(report.component().write_files(folder_.path()), std::runtime_error);
  EXPECT_TRUE(fs::exists(svg()));
}

}  // namespace
}  // namespace armature::report::joints
