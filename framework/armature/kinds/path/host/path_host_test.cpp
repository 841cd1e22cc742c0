// SPDX-License-Identifier: Apache-2.0
// The host of the path planners: 1. one answer for each request, in order, under its header and id,
// 2. requests and paths are carried over as they are, 3. bad requests are answered with their
// reason.
#include <gtest/gtest.h>

#include <stdexcept>

#include "armature/kinds/path/path.hpp"
#include "armature/kinds/request_host_test.hpp"
#include "armature/kinds/tool_pose_messages.hpp"
#include "armature/kinds/zone_messages.hpp"
#include "armature/messages/header.hpp"
#include "armature/runtime/testing/test_plugins.hpp"

namespace armature::path_host {
namespace {

/// To the focus, passing it, and on to the goal in 2.5 s.
class OverTheFocus final : public PathPlanner {
 public:
  static inline PathRequest asked;
  static inline bool throws = false;
  static inline double off = 0;

  Expected<Path> plan(const PathRequest& request) const override {
    asked = request;
    if (throws) throw std::runtime_error{"the matrix is singular"};
    const auto good = checked(request, {.key_poses = true, .zones = true});
    if (!good) return tl::unexpected{good.error()};
    if (!good->focus) return refuse("there is no point to look at");
    ToolPose middle = good->goal;
    middle.position = *good->focus;
    middle.position.y() += off;
    return Path{{.space = PathSegment::Space::joint,
                 .samples = {{1, middle, std::nullopt, good->start_joints}},
                 .stop_at_end = false,
                 .duration_s = {}},
                {.space = PathSegment::Space::cartesian,
                 .samples = {{0, middle}, {0.5, middle, Redundancy{0.07, true}}, {1, good->goal}},
                 .stop_at_end = true,
                 .duration_s = 2.5}};
  }
};

PluginRegistry& plugins() {
  return built_plugins_with<OverTheFocus>(
      "{armature_plugin: 1, id: path/over_the_focus, kind: path}");
}

msg::PathRequest request(std::uint64_t id) {
  msg::PathRequest message;
  write_header(message.header_(), Time{static_cast<std::int64_t>(id) * 1000}, kBaseFrame);
  message.request_id_(id);
  write_tool_pose({{1, 2, 3}, Eigen::Quaterniond{0.5, 0.5, 0.5, 0.5}}, message.start_());
  write_tool_pose({{4, 5, 6}, Direction{{0, 0, -1}}}, message.goal_());
  message.has_focus_(true);
  assign(message.focus_(), Eigen::Vector3d{7, 8, 9});
  write_zones({{"artery", {1, 0, 0}, {2, 0, 0}, 0.003}}, message.forbidden_());
  return message;
}

class PathHostTest : public RequestHostTest<msg::PathRequest, msg::PathResponse> {
 protected:
  PathHostTest()
      : RequestHostTest{
            plugins(),
            {.component = "{plugin: path/over_the_focus}",
             .robot = config::load(ARMATURE_SOURCE_DIR "/configs/robots/dental_lamp.yaml")}} {}
};

TEST_F(PathHostTest, AnswersEveryRequestOnceInOrderUnderItsHeaderAndId) {
  msg::PathRequest bad = request(3);
  bad.has_focus_(false);
  expect_bad_one_refused_between(request(7), bad, request(9));
}

TEST_F(PathHostTest, AsksForThePathOfTheRequest) {
  ask(request(1));
  const PathRequest& asked = OverTheFocus::asked;
  EXPECT_EQ(asked.start.position, (Eigen::Vector3d{1, 2, 3}));
  EXPECT_EQ(std::get<Eigen::Quaterniond>(asked.start.orientation).coeffs(),
            Eigen::Vector4d::Constant(0.5));
  EXPECT_EQ(asked.goal.position, (Eigen::Vector3d{4, 5, 6}));
  EXPECT_EQ(std::get<Direction>(asked.goal.orientation).unit, -Eigen::Vector3d::UnitZ());
  EXPECT_EQ(*asked.focus, (Eigen::Vector3d{7, 8, 9}));
  ASSERT_EQ(asked.forbidden.size(), 1u);
  EXPECT_EQ(asked.forbidden[0].name, "artery");
  EXPECT_EQ(asked.forbidden[0].from, (Eigen::Vector3d{1, 0, 0}));
  EXPECT_EQ(asked.forbidden[0].to, (Eigen::Vector3d{2, 0, 0}));
  EXPECT_EQ(asked.forbidden[0].radius_m, 0.003);
  EXPECT_TRUE(asked.through.empty());
}

TEST_F(PathHostTest, AsksForThePathThroughTheKeyPosesInTheirOrder) {
  msg::PathRequest message = request(1);
  write_tool_pose({{1, 0, 0}, Eigen::Quaterniond{0, 1, 0, 0}}, message.through_().emplace_back());
  write_tool_pose({{2, 0, 0}, Direction{{0, 1, 0}}}, message.through_().emplace_back());
  EXPECT_TRUE(ask(message).valid_());
  const auto& through = OverTheFocus::asked.through;
  ASSERT_EQ(through.size(), 2u);
  EXPECT_EQ(through[0].position, (Eigen::Vector3d{1, 0, 0}));
  EXPECT_EQ(std::get<Eigen::Quaterniond>(through[0].orientation).x(), 1);
  EXPECT_EQ(through[1].position, (Eigen::Vector3d{2, 0, 0}));
  EXPECT_EQ(std::get<Direction>(through[1].orientation).unit, Eigen::Vector3d::UnitY());
}

TEST_F(PathHostTest, TellsTheSegmentsAsTheyAre) {
  const msg::PathResponse answer = ask(request(1));
  EXPECT_TRUE(answer.valid_());
  EXPECT_EQ(answer.reason_(), "");
  ASSERT_EQ(answer.segments_().size(), 2u);
  const msg::PathSegment &first = answer.segments_()[0], &second = answer.segments_()[1];
  EXPECT_EQ(first.space_(), 0);
  EXPECT_FALSE(first.stop_at_end_());
  EXPECT_FALSE(first.has_duration_());
  ASSERT_EQ(first.samples_().size(), 1u);
  EXPECT_EQ(to_eigen(first.samples_()[0].pose_().position_()), (Eigen::Vector3d{7, 8, 9}));
  EXPECT_EQ(second.space_(), 1);
  EXPECT_TRUE(second.stop_at_end_());
  EXPECT_TRUE(second.has_duration_());
  EXPECT_EQ(second.duration_(), 2.5);
  ASSERT_EQ(second.samples_().size(), 3u);
  EXPECT_EQ(second.samples_()[1].s_(), 0.5);
  EXPECT_TRUE(second.samples_()[1].has_redundancy_());
  EXPECT_EQ(second.samples_()[1].redundancy_(), 0.07);
  EXPECT_TRUE(second.samples_()[1].redundancy_is_length_());
  EXPECT_FALSE(second.samples_()[2].has_redundancy_());
  EXPECT_TRUE(second.samples_()[2].pose_().pointing_());
  EXPECT_EQ(to_eigen(second.samples_()[2].pose_().direction_()), -Eigen::Vector3d::UnitZ());
}

TEST_F(PathHostTest, CarriesAllJointsOfTheStartToThePathAndThoseOfAJointSegmentBack) {
  EXPECT_FALSE((ask(request(1)), OverTheFocus::asked.start_joints));
  msg::PathRequest message = request(2);
  const std::vector<double> all{0.1, 0.2, 0.3, -0.3, 0.4, 0.5};  // the fourth follows the third
  message.start_joints_(all);
  const msg::PathResponse answer = ask(message);
  ASSERT_TRUE(answer.valid_()) << answer.reason_();
  EXPECT_EQ(OverTheFocus::asked.start_joints->size(), 5);
  EXPECT_EQ(answer.segments_()[0].samples_()[0].joints_(), all);
  EXPECT_TRUE(answer.segments_()[1].samples_()[0].joints_().empty());
  message.start_joints_().pop_back();
  EXPECT_EQ(ask(message).reason_(), "the start: 5 joint values; dental_lamp has 6 joints");
}

TEST_F(PathHostTest, AnswersABadRequestWithItsReasonAndTheNextOneAsIfNothingHadBeen) {
  const auto refusal = [&](auto change) {
    msg::PathRequest bad = request(5);
    change(bad);
    return refusal_of(bad, request(6));
  };
  EXPECT_EQ(refusal([](auto& r) { r.start_().position_().x_(NAN); }),
            "the start's position is not finite");
  EXPECT_EQ(refusal([](auto& r) { r.start_().orientation_().w_(3); }),
            "the start's quaternion has length 3.1225, not 1");
  EXPECT_EQ(refusal([](auto& r) { r.goal_().direction_().z_(0); }),
            "the goal's direction has length 0, not 1");
  EXPECT_EQ(refusal([](auto& r) { r.focus_().z_(INFINITY); }),
            "the point to look at is not finite");
  EXPECT_EQ(refusal([](auto& r) {
              r.through_().resize(2);
              write_tool_pose({}, r.through_()[0]);
            }),
            "key pose 2's quaternion has length 0, not 1");
  EXPECT_EQ(refusal([](auto& r) { r.has_focus_(false); }), "there is no point to look at");
  EXPECT_EQ(refusal([](auto& r) { r.forbidden_()[0].radius_(-1); }),
            "forbidden zone 'artery' has the radius -1 m");
  EXPECT_EQ(refusal([](auto& r) { r = msg::PathRequest{}; }),
            "the start's quaternion has length 0, not 1");
  EXPECT_EQ(refusal([](auto& r) { r.header_().frame_id_() = "tool"; }),
            "the request is stated in frame 'tool', not in 'base'");
}

TEST_F(PathHostTest, AnAnswerThatIsNotFiniteIsAReason) {
  OverTheFocus::off = NAN;
  const msg::PathResponse answer = ask(request(1));
  OverTheFocus::off = 0;
  EXPECT_FALSE(answer.valid_());
  EXPECT_EQ(answer.reason_(), "the plugin answered a path that is not finite");
  EXPECT_TRUE(ask(request(2)).valid_());
}

TEST_F(PathHostTest, AnExceptionOfThePluginIsAReasonAndTheNextRequestIsAnswered) {
  expect_survives(OverTheFocus::throws, request(1));
}

}  // namespace
}  // namespace armature::path_host
