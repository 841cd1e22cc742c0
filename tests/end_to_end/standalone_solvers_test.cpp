// SPDX-License-Identifier: Apache-2.0
// Solvers that run alone as components answer a program that has only DDS.
#include <gtest/gtest.h>

#include <csignal>

#include "armature/kinds/tool_pose_messages.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "asker.hpp"
#include "command.hpp"
#include "tests/dds_domain.hpp"

namespace armature::test {
namespace {

using Eigen::Vector3d;
using std::chrono::seconds;

const std::string kDeployment = source_file("tests/end_to_end/solvers_alone.yaml");

std::unique_ptr<Transport> join(int domain) {
  return std::move(*FastDdsTransport::make(
      {.network = {.domain = domain}, .deployment = "asker", .now = system_now}));
}

class StandaloneSolvers : public testing::Test {
 protected:
  void SetUp() override {
    const bool connected = path_.connected(seconds{30}) && ik_.connected(seconds{30}) &&
                           select_.connected(seconds{30}) && trajectory_.connected(seconds{30});
    ASSERT_TRUE(connected) << solvers_.err();
  }
  void TearDown() override {
    solvers_.signal(SIGINT);
    EXPECT_EQ(solvers_.finish(seconds{10}).exit_code, 0) << "it has no goals: an end is an end";
  }

  int domain_ = unique_dds_domain();
  Command solvers_{{armature(), "run", kDeployment, "--domain", std::to_string(domain_)}};
  std::unique_ptr<Transport> transport_ = join(domain_);
  Asker<msg::PathRequest, msg::PathResponse> path_{*transport_, "/solvers_alone/path"};
  Asker<msg::IkRequest, msg::IkResponse> ik_{*transport_, "/solvers_alone/ik"};
  Asker<msg::SelectRequest, msg::SelectResponse> select_{*transport_, "/solvers_alone/select"};
  Asker<msg::TrajectoryRequest, msg::TrajectoryResponse> trajectory_{*transport_,
                                                                     "/solvers_alone/trajectory"};
};

/// The paper's example.
msg::IkRequest paper_request() {
  msg::IkRequest request;
  request.request_id_(7);
  write_tool_pose({{1.3, 0.321, 0.504}, Direction{{0.894427, -0.268328, -0.357771}}}, request);
  return request;
}

TEST_F(StandaloneSolvers, IkAnswersARequestWithAllBranches) {
  const auto response = ik_.ask(paper_request());
  ASSERT_TRUE(response);
  EXPECT_EQ(response->request_id_(), 7U);
  EXPECT_EQ(response->status_(), "ok") << response->reason_();
  ASSERT_GE(response->solutions_().size(), 2U);
  const msg::IkSolution& first = response->solutions_()[0];
  EXPECT_EQ(first.label_(), "tilt0/balance0/elbow0");
  const std::vector<double> paper{1.1435, -1.3390, 0.0476, -0.0476, -0.0960, -0.3659};
  ASSERT_EQ(first.joints_().size(), paper.size());
  for (std::size_t i = 0; i < paper.size(); ++i) EXPECT_NEAR(first.joints_()[i], paper[i], 1e-4);
  EXPECT_LT(first.residual_m_(), 1e-9);
  EXPECT_TRUE(first.within_limits_());

  msg::IkRequest far_away = paper_request();
  far_away.request_id_(8);
  far_away.position_().x_(9);
  const auto refused = ik_.ask(far_away);
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->request_id_(), 8U);
  EXPECT_EQ(refused->status_(), "out_of_reach");
  EXPECT_NE(refused->reason_(), "");
  EXPECT_TRUE(refused->solutions_().empty());
}

/// What a motion component does with its four slots, done from outside with four questions.
TEST_F(StandaloneSolvers, TogetherPlanAMotionForAProgramThatHasOnlyDds) {
  const RobotModel lamp = load_robot_model(source_file("configs/robots/dental_lamp.yaml"));
  const JointVector home = resting_position(lamp);
  const Eigen::Isometry3d base_T_tool = forward_kinematics(lamp, home);
  const ToolPose goal{{1.05, 0, 0.45}, Direction{{1, 0, 0}}};  // 50 cm before the mouth

  msg::PathRequest where;
  where.request_id_(1);
  write_tool_pose({base_T_tool.translation(), Direction{base_T_tool.linear().col(0)}},
                  where.start_());
  write_tool_pose(goal, where.goal_());
  where.has_focus_(true);
  assign(where.focus_(), Vector3d{1.55, 0, 0.45});
  const auto path = path_.ask(where);
  ASSERT_TRUE(path);
  EXPECT_EQ(path->request_id_(), 1U);
  ASSERT_TRUE(path->valid_()) << path->reason_();
  ASSERT_EQ(path->segments_().size(), 2U);

  msg::SelectRequest which;
  which.request_id_(2);
  for (const msg::PathSegment& segment : path->segments_()) {
    for (const msg::PathSample& sample : segment.samples_()) {
      if (sample.s_() == 0) continue;  // where the segment before ended
      msg::IkRequest how;
      write_tool_pose(tool_pose_of(sample.pose_()), how);
      const auto found = ik_.ask(how);
      ASSERT_TRUE(found);
      ASSERT_EQ(found->status_(), "ok") << found->reason_();
      which.waypoints_().emplace_back().solutions_() = found->solutions_();
    }
  }
  const auto chosen = select_.ask(which);
  ASSERT_TRUE(chosen);
  EXPECT_EQ(chosen->request_id_(), 2U);
  ASSERT_TRUE(chosen->valid_()) << chosen->reason_();
  ASSERT_EQ(chosen->waypoints_().size(), which.waypoints_().size());

  msg::TrajectoryRequest when;
  when.request_id_(3);
  auto next = chosen->waypoints_().begin();
  msg::JointPosition last;
  const JointVector all = lamp.to_all(home);
  last.joints_().assign(all.begin(), all.end());
  for (const msg::PathSegment& segment : path->segments_()) {
    auto& joints = when.segments_().emplace_back();
    joints.stop_at_end_(segment.stop_at_end_());
    joints.s_() = {0};
    joints.waypoints_() = {last};
    for (const msg::PathSample& sample : segment.samples_()) {
      if (sample.s_() == 0) continue;
      joints.s_().push_back(sample.s_());
      joints.waypoints_().push_back(*next++);
    }
    last = joints.waypoints_().back();
  }
  const auto planned = trajectory_.ask(when);
  ASSERT_TRUE(planned);
  EXPECT_EQ(planned->request_id_(), 3U);
  ASSERT_TRUE(planned->valid_()) << planned->reason_();
  const msg::QuinticTrajectory& trajectory = planned->trajectory_();
  EXPECT_EQ(trajectory.goal_id_(), 3U);
  const std::size_t dof = trajectory.joint_names_().size(), pieces = trajectory.knots_().size() - 1;
  ASSERT_EQ(dof, 5U);
  ASSERT_EQ(trajectory.coefficients_().size(), pieces * dof * 6);

  // Where the last piece ends is where the goal wants the tool.
  JointVector end(5);
  const double t = trajectory.knots_()[pieces] - trajectory.knots_()[pieces - 1];
  for (std::size_t j = 0; j < dof; ++j) {
    const double* c = trajectory.coefficients_().data() + ((pieces - 1) * dof + j) * 6;
    end[static_cast<Eigen::Index>(j)] =
        c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5]))));
  }
  const PoseResidual left = residual(forward_kinematics(lamp, end), *lamp.pointing_axis(), goal);
  EXPECT_LT(left.position_m, 1e-8);
  EXPECT_LT(left.angle_rad, 1e-8);
}

TEST_F(StandaloneSolvers, RefuseABadRequestWithAReasonAndAnswerTheNext) {
  const auto path = path_.ask({});
  ASSERT_TRUE(path);
  EXPECT_EQ(path->reason_(), "the start's quaternion has length 0, not 1");
  msg::SelectRequest which;
  which.waypoints_().resize(3);
  const auto chosen = select_.ask(which);
  ASSERT_TRUE(chosen);
  EXPECT_EQ(chosen->reason_(), "waypoint 1 of 3: no branch");
  const auto planned = trajectory_.ask({});
  ASSERT_TRUE(planned);
  EXPECT_EQ(planned->reason_(), "there is no waypoint");
  const auto good = ik_.ask(paper_request());
  ASSERT_TRUE(good);
  EXPECT_EQ(good->status_(), "ok");
}

TEST(StandaloneSolversFile, PassesTheCheck) {
  const CommandResult check = run_command({armature(), "check", kDeployment});
  EXPECT_EQ(check.exit_code, 0) << check.err;
}

}  // namespace
}  // namespace armature::test
