// SPDX-License-Identifier: Apache-2.0
// An arm that is given any goals at any instants, and is stopped and rearmed between, keeps these
// rules: 1. its reference and it keep their limits and do not jump, 2. every goal comes to one end,
// a refused one with a reason, 3. one that is done is where it should be, 4. on straight ways and
// their blends the tool stays on them, whatever stops it there, 5. no body is in a forbidden zone
// of its goal, 6. at the end the arm rests, and a goal where it stands is done. ARMATURE_GOALS: so
// many of them, from number ARMATURE_FIRST_GOAL on; `tools/test --full` has others every day.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

#include "any_arm.hpp"
#include "armature/robot/geometry/pose_goal.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "armature/robot/orientations/orientation_curve.hpp"
#include "armature/values/file_content.hpp"
#include "blended_way.hpp"
#include "deployment_run.hpp"
#include "goal_chronicle.hpp"
#include "tests/environment_number.hpp"

namespace armature::test {
namespace {

using Eigen::Vector3d;

double distance_to_line(const Vector3d& p, const Vector3d& from, const Vector3d& to) {
  const Vector3d along = to - from;
  const double part = along.isZero(0) ? 0 : (p - from).dot(along) / along.squaredNorm();
  return (from + std::clamp(part, 0.0, 1.0) * along - p).norm();
}

/// Between two lines; the distance of a point that goes along the one has one minimum.
double distance_of_lines(const Vector3d& from, const Vector3d& to, const GivenZone& zone) {
  const auto at = [&](double part) {
    return distance_to_line(from + part * (to - from), zone.from, zone.to);
  };
  double low = 0, high = 1;
  for (int i = 0; i < 40; ++i) {
    const double third = (high - low) / 3;
    const bool lower = at(low + third) < at(high - third);
    low += lower ? 0 : third;
    high -= lower ? third : 0;
  }
  return at((low + high) / 2);
}

/// Who is asked for what.
struct AskedArm {
  explicit AskedArm(int seed);

  void expect_limits(const GoalChronicle& told) const;
  void expect_jerk(const GoalChronicle& told) const;
  void expect_ends(const GoalChronicle& told) const;
  void expect_straight(const GoalChronicle& told) const;
  void expect_zones(const GoalChronicle& told) const;
  void expect_rest(const GoalChronicle& told) const;

  /// From when until when the arm is on the way of a goal, or stands on it.
  struct Span {
    int id;
    double from_s, to_s;
  };
  std::vector<Span> spans_of(const GoalChronicle& told) const;
  const ArmRow& reference_at(const GoalChronicle& told, double time_s) const;
  const ArmRow* stands_in(const GoalChronicle& told, const Span& span) const;
  double keeps_away_from_s(const GoalChronicle& told, const Span& span) const;
  double nearest_body(const JointVector& q, const GivenZone& zone, bool entered) const;
  Vector3d axis() const { return robot.pointing_axis().value_or(Vector3d::UnitX()); }

  Lot lot;
  TemporaryFolder folder;
  std::optional<AnyArm> drawn;
  std::string robot_file, path, interpolator;
  RobotModel robot;
  bool path_only = false, zones = false;
  double period_s = 0.001, max_jerk = 0;
  std::vector<std::string> settings;

 private:
  RobotModel any_robot();
};

RobotModel AskedArm::any_robot() {
  const auto* known = lot.one_of(Words{"", "", "", "med7", "sr1", "sr1_needle", "dental_lamp"});
  robot_file = source_file(fmt::format("configs/robots/{}.yaml", known));
  if (*known) return load_robot_model(robot_file);
  drawn.emplace(lot, lot.one_of({3, 5, 6, 6, 7, 7, 8}));
  drawn->draw_bodies(lot);
  drawn->write(folder);
  robot_file = folder / "arm.yaml";
  return load_robot_model(robot_file);
}

AskedArm::AskedArm(int seed) : lot{seed}, robot{any_robot()} {
  const std::string name = robot.name();
  const bool asks_for_lines = robot.pointing_axis().has_value() && lot.happens(0.4);
  path = asks_for_lines
             ? "needle"
             : lot.one_of(Words{"orientations", "orientations", "orientations", "joint_move"});
  interpolator = lot.one_of(Words{"slerp", "squad", "rotvec_bspline", "chart_bspline"});
  zones = !robot.capsules().empty() && lot.happens(0.5);
  path_only = path == "needle" || lot.happens(zones ? 0.2 : 0.7);
  period_s = lot.one_of({0.001, 0.002, 0.005, 0.01});
  max_jerk = lot.one_of({0.0, 0.0, 5.0, 50.0});
  std::string ik = "numeric";
  if (name == "med7" && lot.happens(0.5)) ik = "srs_arm_angle";
  if (name.starts_with("sr1") && lot.happens(0.6)) ik = "puma_algebraic";
  const auto* trajectory = lot.one_of(Words{"quintic", "quintic_spline", "cubic_spline"});
  settings = {fmt::format("components.anybody.params.seed={}", seed),
              fmt::format("components.anybody.params.haste={}", lot.one_of({0.0, 0.3, 0.8})),
              fmt::format("components.anybody.params.stops={}", lot.one_of({0.0, 0.1, 0.3})),
              fmt::format("components.anybody.params.zones={}", zones),
              fmt::format("components.anybody.params.entries={}", path == "needle"),
              fmt::format("components.motion.path.plugin=path/{}", path),
              fmt::format("components.motion.ik.plugin=ik/{}", ik),
              fmt::format("components.motion.trajectory.plugin=trajectory/{}", trajectory),
              fmt::format("components.motion.params.path_only={}", path_only),
              fmt::format("components.motion.params.rate_hz={}", 1 / period_s),
              fmt::format("components.arm.params.rate_hz={}", 1 / period_s),
              fmt::format("executors.control.period_s={}", period_s)};
  for (int i = 0; i < robot.dof() && max_jerk > 0; ++i) {
    settings.push_back(fmt::format("components.motion.params.max_jerk_{}_s3={}",
                                   robot.is_revolute(i) ? "rad" : "m", max_jerk));
  }
  if (path == "orientations") {
    settings.push_back("components.motion.path.params.interpolator=" + interpolator);
  }
}

// 1.

void AskedArm::expect_limits(const GoalChronicle& told) const {
  constexpr double kOfALimit = 1.001, kBeyond = 1e-6;  // what motion allows a trajectory
  JointVector fastest = robot.max_velocity(), hardest = robot.max_acceleration();
  for (int i = 0; i < robot.dof(); ++i) {
    if (!robot.is_revolute(i)) continue;
    fastest[i] = std::min(fastest[i], 1.0);
    hardest[i] = std::min(hardest[i], 2.5);
  }
  for (const auto* rows : {&told.reference, &told.arm}) {
    const ArmRow* before = nullptr;
    for (const ArmRow& row : *rows) {
      ASSERT_TRUE(robot.within_limits(row.q, kBeyond)) << row.time_s << " s: " << row.q.transpose();
      ASSERT_LE(row.v.cwiseAbs().cwiseQuotient(fastest).maxCoeff(), kOfALimit)
          << row.time_s << " s: " << row.v.transpose();
      ASSERT_LE(row.a.cwiseAbs().cwiseQuotient(hardest).maxCoeff(), kOfALimit)
          << row.time_s << " s: " << row.a.transpose();
      if (before) {
        const double dt = row.time_s - before->time_s;
        ASSERT_LE((row.q - before->q).cwiseAbs().cwiseQuotient(fastest).maxCoeff(),
                  kOfALimit * dt + 1e-9)
            << row.time_s << " s: a jump to " << row.q.transpose();
        ASSERT_LE((row.v - before->v).cwiseAbs().cwiseQuotient(hardest).maxCoeff(),
                  kOfALimit * dt + 1e-9)
            << row.time_s << " s: a jump to " << row.v.transpose() << " from "
            << before->v.transpose();
      }
      before = &row;
    }
  }
}

/// Of a goal for which the arm sets out at rest, until something else is wanted.
void AskedArm::expect_jerk(const GoalChronicle& told) const {
  constexpr double kOfALimit = 1.001;
  if (max_jerk == 0) return;
  for (const Span& span : spans_of(told)) {
    if (!reference_at(told, span.from_s).rests()) continue;
    double to_s = span.to_s;
    for (const auto& [id, goal] : told.goals) {
      if (goal.time_s > span.from_s) to_s = std::min(to_s, goal.time_s);
    }
    for (const double stop_s : told.stops_s) {
      if (stop_s > span.from_s) to_s = std::min(to_s, stop_s);
    }
    const ArmRow* before = nullptr;
    for (const ArmRow& row : told.reference) {
      if (row.time_s < span.from_s || row.time_s >= to_s) continue;
      if (before) {
        const double dt = row.time_s - before->time_s;
        ASSERT_LE((row.a - before->a).cwiseAbs().maxCoeff(), kOfALimit * max_jerk * dt + 1e-9)
            << row.time_s << " s, on the way of goal " << span.id;
      }
      before = &row;
    }
  }
}

// 2. and 3.

void AskedArm::expect_ends(const GoalChronicle& told) const {
  std::map<int, int> ends;
  for (const GoalStatusLine& status : told.statuses) {
    if (status.state < GoalStatusLine::done || status.stage == "stop") continue;
    if (status.reason.starts_with("the arm was stopped and rearmed since;")) continue;
    ++ends[status.id];
    EXPECT_EQ(status.state == GoalStatusLine::failed, !status.reason.empty()) << status.id;
    if (status.stage == "links") {
      const auto& named = told.goals.at(status.id).zones;
      EXPECT_TRUE(std::ranges::any_of(named, [&](const GivenZone& zone) {
        return status.reason.find("'" + zone.name + "'") != std::string::npos;
      })) << status.reason;
    }
    const GivenGoal& goal = told.goals.at(status.id);
    const bool ends_at_pose = goal.mode == GivenGoal::Mode::planned && !goal.stepwise;
    if (status.state != GoalStatusLine::done || !ends_at_pose) continue;
    const ArmRow& at = reference_at(told, status.time_s);
    const PoseResidual miss = residual(forward_kinematics(robot, at.q), axis(), goal.poses.back());
    EXPECT_LE(miss.position_m + miss.angle_rad, 3e-6) << "goal " << status.id;
  }
  for (const auto& [id, goal] : told.goals) {
    const bool by_stop = std::ranges::any_of(told.statuses, [&, id = id](const auto& status) {
      return status.id == id && status.stage == "stop";
    });
    // A hand that has the arm keeps it until somebody wants something else.
    const bool in_hand = goal.mode == GivenGoal::Mode::guided;
    EXPECT_TRUE(ends[id] > 0 || by_stop || in_hand) << "goal " << id << " has no end";
    EXPECT_LE(ends[id], 1) << "goal " << id << " ended so often";
  }
}

const ArmRow& AskedArm::reference_at(const GoalChronicle& told, double time_s) const {
  const auto behind = std::ranges::upper_bound(told.reference, time_s + 1e-7, {}, &ArmRow::time_s);
  return behind == told.reference.begin() ? *behind : *std::prev(behind);
}

constexpr double kSlow = 1e-3;  // [rad/s] or [m/s]: a rest may be between two periods

/// Where the arm stands first on the way of a goal: at its begin, or behind the stop of the motion
/// before.
const ArmRow* AskedArm::stands_in(const GoalChronicle& told, const Span& span) const {
  const ArmRow& begin = reference_at(told, span.from_s);
  if (begin.rests()) return &begin;
  const auto stands = std::ranges::find_if(told.reference, [&](const ArmRow& row) {
    return row.time_s >= span.from_s && row.time_s < span.to_s && row.v.isZero(kSlow);
  });
  return stands == told.reference.end() ? nullptr : &*stands;
}

std::vector<AskedArm::Span> AskedArm::spans_of(const GoalChronicle& told) const {
  std::vector<Span> spans;
  for (const GoalStatusLine& status : told.statuses) {
    if (status.state != GoalStatusLine::executing) continue;
    const auto mode = told.goals.at(status.id).mode;
    using enum GivenGoal::Mode;
    const bool leaves = mode == planned || mode == tracking || mode == guided;
    if (!leaves || (!spans.empty() && spans.back().id == status.id)) continue;
    if (!spans.empty()) spans.back().to_s = std::min(spans.back().to_s, status.time_s);
    spans.push_back({status.id, status.time_s, 1e9});
  }
  std::erase_if(spans, [&](const Span& span) {
    return told.goals.at(span.id).mode != GivenGoal::Mode::planned;
  });
  return spans;
}

// 4.

void AskedArm::expect_straight(const GoalChronicle& told) const {
  // max_path_deviation, which is looked at in three places between two samples.
  constexpr double kEvery_s = 0.005, kStep_m = 0.002, kStep_rad = 0.5 * M_PI / 180;
  constexpr double kLeaves_m = 1.1 * 0.0005, kLeaves_rad = 1.1 * 0.25 * M_PI / 180;
  for (const Span& span : spans_of(told)) {
    const GivenGoal& goal = told.goals.at(span.id);
    const bool is_bound = path_only || goal.poses.size() > 1 || !goal.zones.empty();
    if (path != "orientations" || !is_bound) continue;
    const ArmRow* begin = stands_in(told, span);
    if (!begin) continue;
    const Eigen::Isometry3d tool = forward_kinematics(robot, begin->q);
    ToolPose start{tool.translation(), Eigen::Quaterniond{tool.linear()}};
    if (std::holds_alternative<Direction>(goal.poses.back().orientation)) {
      start.orientation = Direction{tool.linear() * axis()};
    }
    std::vector<ToolPose> poses{start};
    poses.insert(poses.end(), goal.poses.begin(), goal.poses.end());
    // Between three samples a way with key poses bends by a step of path/orientations at most.
    const bool bends = poses.size() > 2;
    const double may_m = kLeaves_m + (bends ? kStep_m : 0);
    const double may_rad = kLeaves_rad + (bends ? kStep_rad : 0);
    BlendedWay way{poses, *orientation_interpolator(interpolator)};
    double next_s = begin->time_s;
    for (const ArmRow& row : told.arm) {
      if (row.time_s < next_s || row.time_s >= span.to_s) continue;
      next_s = row.time_s + kEvery_s;
      const Miss miss = way.miss_of(forward_kinematics(robot, row.q), axis());
      ASSERT_LE(miss.position_m, may_m) << row.time_s << " s, on the way of goal " << span.id;
      ASSERT_LE(miss.angle_rad, may_rad) << row.time_s << " s, on the way of goal " << span.id;
    }
  }
}

// 5.

double AskedArm::nearest_body(const JointVector& q, const GivenZone& zone, bool entered) const {
  double nearest = INFINITY;
  const auto see = [&](const Vector3d& from, const Vector3d& to, double radius) {
    nearest = std::min(nearest, distance_of_lines(from, to, zone) - radius - zone.radius);
  };
  const auto point = [](const KDL::Vector& p) { return Vector3d{p.x(), p.y(), p.z()}; };
  if (drawn) {
    for (const AnyBody& body : drawn->bodies) {
      const KDL::Frame at = drawn->frame(body.link, q.data());
      see(point(at * body.from), point(at * body.to), body.radius);
    }
    return nearest;
  }
  std::vector<Eigen::Isometry3d> frames(static_cast<std::size_t>(robot.joint_count()));
  joint_frames(robot, q, frames);
  const int carrier = robot.frame(robot.tool()).parent_joint;
  for (const LinkCapsule& body : robot.capsules()) {
    if (entered && body.parent_joint == carrier) continue;
    const Eigen::Isometry3d at = body.parent_joint < 0
                                     ? Eigen::Isometry3d::Identity()
                                     : frames[static_cast<std::size_t>(body.parent_joint)];
    see(at * body.from, at * body.to, body.radius);
  }
  return nearest;
}

/// The plan takes over when its budget is over, and the arm follows the reference. A stop that
/// comes first, out of a motion that knew nothing of the zones, is not looked at.
double AskedArm::keeps_away_from_s(const GoalChronicle& told, const Span& span) const {
  const double begin_s = span.from_s + 0.01 + 3 * period_s;
  if (reference_at(told, span.from_s).rests()) return begin_s;
  const ArmRow* stands = stands_in(told, span);
  const auto goes_on = [&](const ArmRow& row) {
    return stands && row.time_s > stands->time_s && row.time_s < span.to_s && !row.v.isZero(kSlow);
  };
  if (std::ranges::none_of(told.reference, goes_on)) return begin_s;
  return std::max(begin_s, stands->time_s + 3 * period_s);
}

void AskedArm::expect_zones(const GoalChronicle& told) const {
  constexpr double kKept_m =
      0.001 - 0.00006;  // min_link_clearance_mm, and what is between instants
  for (const Span& span : spans_of(told)) {
    const double from_s = keeps_away_from_s(told, span);
    for (const GivenZone& zone : told.goals.at(span.id).zones) {
      for (const ArmRow& row : told.arm) {
        if (row.time_s < from_s || row.time_s >= span.to_s) continue;
        ASSERT_GE(nearest_body(row.q, zone, path == "needle" && zone.tool_enters), kKept_m)
            << row.time_s << " s, goal " << span.id << ", " << zone.name;
      }
    }
  }
}

// 6.

void AskedArm::expect_rest(const GoalChronicle& told) const {
  const auto last = std::ranges::find_if(told.statuses, [&](const GoalStatusLine& status) {
    return status.id == told.last && status.state >= GoalStatusLine::done;
  });
  ASSERT_TRUE(last != told.statuses.end());
  const ArmRow& stood = reference_at(told, told.goals.at(told.last).time_s);
  const ArmRow &stands = told.reference.back(), &arm = told.arm.back();
  EXPECT_TRUE(stands.rests());
  EXPECT_LE((stands.q - arm.q).cwiseAbs().maxCoeff(), 1e-8);
  if (path == "needle") return;  // it is asked for more than a place
  EXPECT_EQ(last->state, GoalStatusLine::done) << last->stage << ": " << last->reason;
  EXPECT_LE((stands.q - stood.q).cwiseAbs().maxCoeff(), 1e-5) << stood.q.transpose();
}

TEST(AnyGoal, KeepsAnArmWithinItsLimitsOnItsWayAndOutOfItsZones) {
  const int first = environment_number("ARMATURE_FIRST_GOAL", 1),
            count = environment_number("ARMATURE_GOALS", 5);
  for (int seed = first; seed < first + count; ++seed) {
    const AskedArm asked{seed};
    DeploymentStart start{.files = {source_file("tests/by_lot/any_goal.yaml")},
                          .settings = asked.settings};
    start.options.environment = {{"ARMATURE_PLUGIN_PATH", TEST_PLUGINS},
                                 {"ARM_FILE", asked.robot_file},
                                 {"ARM_FOLDER", asked.folder.path()}};
    const DeploymentRun run = run_deployment(start);
    const std::string file = asked.folder / "chronicle";
    if (!std::filesystem::exists(file)) throw std::runtime_error{run.text()};
    const GoalChronicle told = read_goals(content_of(file), asked.robot.dof());
    SCOPED_TRACE(fmt::format("ARMATURE_FIRST_GOAL={} ARMATURE_GOALS=1\n{}\n{}\n{}\n{}{}", seed,
                             asked.robot_file, fmt::join(asked.settings, "\n"),
                             asked.drawn ? asked.drawn->urdf : "", told.story, run.text()));
    EXPECT_EQ(run.status(), "ok");
    EXPECT_EQ(run.report.find("time limit"), std::string::npos);
    asked.expect_limits(told);
    asked.expect_jerk(told);
    asked.expect_ends(told);
    asked.expect_straight(told);
    asked.expect_zones(told);
    asked.expect_rest(told);
  }
}

}  // namespace
}  // namespace armature::test
