// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/path/laws.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "armature/kinds/path/random_poses.hpp"
#include "armature/robot/kinematics/kinematics.hpp"

namespace armature {
namespace {

const Eigen::Vector3d kFocus{1.55, 0, 0.45};
constexpr std::uint64_t kSeed = 17;

std::string words(const Eigen::Vector3d& p) {
  return fmt::format("({}, {}, {})", p.x(), p.y(), p.z());
}

std::string words(const ToolPose& pose) {
  if (const auto* direction = std::get_if<Direction>(&pose.orientation)) {
    return fmt::format("{} m pointing to {}", words(pose.position), words(direction->unit));
  }
  const auto& turn = std::get<Eigen::Quaterniond>(pose.orientation);
  return fmt::format("{} m turned by the quaternion w {}, xyz {}", words(pose.position), turn.w(),
                     words(turn.vec()));
}

std::string words(const PathRequest& request) {
  std::string all = "from " + words(request.start);
  for (const ToolPose& key : request.through) all += " through " + words(key);
  return all + " to " + words(request.goal) +
         (request.focus ? ", looking at " + words(*request.focus) : ", nothing to look at");
}

/// "seed 17, round 3: from (0.1, 0, 0) m pointing to ...".
void asks(int round, const PathRequest& request, LawCheck& check) {
  check.asks(fmt::format("seed {}, round {}: {}", kSeed, round, words(request)));
}

/// Before the focus, looking at it up to `miss` [rad] off.
ToolPose looking_at_focus(RandomPoses& random, double distance, double miss) {
  const Eigen::Vector3d outward = random.unit();
  const Eigen::Vector3d aside = outward.cross(random.unit()).normalized();
  const double angle = random.between(0, miss);
  return {kFocus + distance * outward,
          Direction{-std::cos(angle) * outward + std::sin(angle) * aside}};
}

/// `usual`, or 0 where a goal has to look at its focus exactly.
double miss(const PathSubject& subject, double usual) { return subject.along_a_line ? 0 : usual; }

/// Towards the focus; along a line from before it.
PathRequest towards_focus(const PathSubject& subject, ToolPose start, const ToolPose& goal) {
  const bool behind = (start.position - kFocus).dot(goal.position - kFocus) < 0;
  if (subject.along_a_line && behind) start.position = 2 * kFocus - start.position;
  return {.start = start, .goal = goal, .focus = kFocus};
}

/// The joints that a path names take the tool to where it says.
void check_joints(const RobotModel& model, const Path& path, LawCheck& check) {
  constexpr double kMayMiss = 1e-6;  // [m] and [rad]; motion refuses more
  const Eigen::Vector3d axis = model.pointing_axis().value_or(Eigen::Vector3d::UnitX());
  for (const PathSegment& segment : path) {
    for (const PathSample& sample : segment.samples) {
      if (!sample.joints) continue;
      if (!check.that(sample.joints->size() == model.dof(),
                      "joints that a sample names are as many as the robot has")) {
        return;
      }
      const PoseResidual miss =
          residual(forward_kinematics(model, *sample.joints), axis, sample.pose);
      check.at_most(miss.position_m, kMayMiss,
                    "from where a sample's joints take the tool to its pose [m]");
      check.at_most(miss.angle_rad, kMayMiss,
                    "from how a sample's joints turn the tool to its pose [rad]");
    }
  }
}

void check_planned(const PathSubject& subject, const PathRequest& request, LawCheck& check) {
  const auto path = subject.planner->plan(request);
  if (!check.answered(path, "this request")) return;
  check_sound(*path, request, check);
  if (subject.model) check_joints(*subject.model, *path, check);
}

void keeps_away(const PathSubject& subject, LawCheck& check) {
  RandomPoses random{kSeed};
  PathRequest request{.start = looking_at_focus(random, 0.6, 0.1),
                      .goal = looking_at_focus(random, 0.5, 0),
                      .focus = kFocus};
  request.forbidden = {{"everything", kFocus, kFocus, 10}};
  check.asks(words(request) + ", with all within 10 m of the point to look at forbidden");
  check.refused(subject.planner->plan(request),
                "a request whose start, goal and all between are forbidden");
}

void start_to_goal(const PathSubject& subject, LawCheck& check) {
  RandomPoses random{kSeed};
  const auto planned = [&](int round, const ToolPose& start, const ToolPose& goal) {
    const PathRequest request = towards_focus(subject, start, goal);
    asks(round, request, check);
    check_planned(subject, request, check);
  };
  for (int i = 0; i < 500; ++i) {
    const double distance = random.between(0.2, 1);
    const ToolPose anywhere = looking_at_focus(random, random.between(0.2, 1), M_PI);
    planned(i, anywhere, looking_at_focus(random, distance, miss(subject, 0.1)));
    const ToolPose as_far = looking_at_focus(random, distance + random.between(-0.1, 0.1), 0.2);
    planned(i, as_far, looking_at_focus(random, distance, 0));
  }
}

void without_focus(const PathSubject& subject, LawCheck& check) {
  RandomPoses random{kSeed};
  if (subject.along_a_line) {
    const PathRequest request{.start = looking_at_focus(random, 0.6, 0),
                              .goal = looking_at_focus(random, 0.5, 0)};
    asks(0, request, check);
    check.refused(subject.planner->plan(request), "a request without a point to look at");
    return;
  }
  const auto planned = [&](int round, const PathRequest& request) {
    asks(round, request, check);
    check_planned(subject, request, check);
  };
  for (int i = 0; i < 100; ++i) {
    planned(i, {.start = {random.unit(), Direction{random.unit()}},
                .goal = {random.unit(), Direction{random.unit()}}});
    planned(i, {.start = {random.unit(), random.rotation()},
                .goal = {random.unit(), random.rotation()}});
  }
}

void already_there(const PathSubject& subject, LawCheck& check) {
  RandomPoses random{kSeed};
  for (int i = 0; i < 100; ++i) {
    const ToolPose here =
        looking_at_focus(random, random.between(0.2, 1), i % 2 == 0 ? 0 : miss(subject, 1.5));
    PathRequest request{.start = here, .goal = here, .focus = kFocus};
    asks(i, request, check);
    check_planned(subject, request, check);
    if (subject.along_a_line) continue;
    request.focus.reset();
    asks(i, request, check);
    check_planned(subject, request, check);
  }
}

void check_equal(const PathSample& a, const PathSample& b, LawCheck& check) {
  check.equal(a.s, b.s, "a sample's parameter s");
  check.that(a.pose.position == b.pose.position, "equal requests give samples at equal positions");
  const auto* first = std::get_if<Direction>(&a.pose.orientation);
  const auto* second = std::get_if<Direction>(&b.pose.orientation);
  if (!check.that(first && second, "between directions every sample has a direction")) return;
  check.that(first->unit == second->unit, "equal requests give samples with equal directions");
}

void check_equal(const Path& a, const Path& b, LawCheck& check) {
  if (!check.equal(a.size(), b.size(), "the number of segments")) return;
  for (std::size_t k = 0; k < a.size(); ++k) {
    check.that(a[k].space == b[k].space, "equal requests give segments in the same space");
    check.equal(a[k].stop_at_end, b[k].stop_at_end, "whether a segment ends with a stop");
    check.that(a[k].duration_s == b[k].duration_s, "equal requests give equal durations");
    if (!check.equal(a[k].samples.size(), b[k].samples.size(), "a segment's samples")) return;
    for (std::size_t n = 0; n < a[k].samples.size(); ++n) {
      check_equal(a[k].samples[n], b[k].samples[n], check);
    }
  }
}

void equal_requests(const PathSubject& subject, LawCheck& check) {
  const PathPlanner& planner = *subject.planner;
  RandomPoses random{kSeed};
  for (int i = 0; i < 20; ++i) {
    const ToolPose start = looking_at_focus(random, 0.6, 0.3);
    const PathRequest request = towards_focus(subject, start, looking_at_focus(random, 0.5, 0));
    asks(i, request, check);
    const auto first = planner.plan(request);
    static_cast<void>(planner.plan({.start = request.goal, .goal = request.start}));
    const auto second = planner.plan(request);
    if (!check.answered(first, "this request") || !check.answered(second, "the same request")) {
      return;
    }
    check_equal(*first, *second, check);
  }
}

void nearly_unit(const PathSubject& subject, LawCheck& check) {
  RandomPoses random{kSeed};
  const ToolPose start = looking_at_focus(random, 0.6, 0);
  PathRequest request = towards_focus(subject, start, looking_at_focus(random, 0.5, 0));
  const PathRequest exact = request;
  std::get<Direction>(request.start.orientation).unit *= 1.005;
  std::get<Direction>(request.goal.orientation).unit *= 0.995;
  check.asks(words(request));
  const auto path = subject.planner->plan(request);
  if (!check.answered(path, "a request whose directions have the lengths 1.005 and 0.995")) return;
  check_sound(*path, exact, check);
}

/// Only the answer without a point to look at has to have just these words.
void bad_requests(const PathSubject& subject, LawCheck& check) {
  RandomPoses random{kSeed};
  const PathRequest good{.start = looking_at_focus(random, 0.6, 0),
                         .goal = looking_at_focus(random, 0.5, 0),
                         .focus = kFocus};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused_with = [&](std::string_view reason, auto change) {
    PathRequest focused = good, unfocused = good;
    unfocused.focus.reset();
    change(focused);
    change(unfocused);
    check.asks(words(focused));
    check.that(!subject.planner->plan(focused), "this request is refused");
    check.asks(words(unfocused));
    check.refused_with(subject.planner->plan(unfocused), reason);
  };
  refused_with("the start's position is not finite", [&](auto& r) { r.start.position.x() = nan; });
  refused_with("the goal's position is not finite",
               [&](auto& r) { r.goal.position.z() = INFINITY; });
  refused_with("the start's direction has length 0, not 1", [&](auto& r) {
    r.start.orientation = Direction{{0, 0, 0}};
  });
  refused_with("the goal's direction has length nan, not 1", [&](auto& r) {
    r.goal.orientation = Direction{{nan, 0, 0}};
  });
  refused_with("the goal's quaternion has length 2, not 1", [&](auto& r) {
    r.goal.orientation = Eigen::Quaterniond{2, 0, 0, 0};
  });
  refused_with("key pose 2's position is not finite", [&](auto& r) {
    r.through = {good.start, {{0, nan, 0}, Direction{}}};
  });
  refused_with("the point to look at is not finite", [&](auto& r) {
    r.focus = Eigen::Vector3d{0, nan, 0};
  });
}

void key_poses(const PathSubject& subject, LawCheck& check) {
  RandomPoses random{kSeed};
  for (int i = 0; i < 100; ++i) {
    PathRequest request{.start = {random.unit(), random.rotation()},
                        .goal = {random.unit(), random.rotation()}};
    for (int k = 0; k < 1 + i % 3; ++k) {
      request.through.push_back({random.unit(), random.rotation()});
    }
    asks(i, request, check);
    const auto path = subject.planner->plan(request);
    if (path) {
      check_sound(*path, request, check);
    } else {
      check.refused_with(path, checked(request).error().text);
    }
  }
}

void awkward_requests(const PathSubject& subject, LawCheck& check) {
  const ToolPose before{kFocus + Eigen::Vector3d{-0.5, 0, 0}, Direction{{1, 0, 0}}};
  const ToolPose behind{kFocus + Eigen::Vector3d{0.5, 0, 0}, Direction{{-1, 0, 0}}};
  const ToolPose above{kFocus + Eigen::Vector3d{0, 0, 0.5}, Direction{{0, 0, -1}}};
  const ToolPose below{kFocus - Eigen::Vector3d{0, 0, 0.5}, Direction{{0, 0, 1}}};
  const ToolPose on_it{kFocus, Direction{{1, 0, 0}}};
  const ToolPose beside_it{kFocus + Eigen::Vector3d{-1e-7, 0, 0}, Direction{{1, 0, 0}}};
  const ToolPose looking_away{before.position, Direction{{-1, 0, 0}}};
  const ToolPose turned{before.position, Eigen::Quaterniond::Identity()};
  const ToolPose far_away{kFocus + Eigen::Vector3d{-1e6, 0, 0}, Direction{{1, 0, 0}}};
  const std::vector<ToolPose> poses{before,    behind,       above,  below,   on_it,
                                    beside_it, looking_away, turned, far_away};
  for (const ToolPose& start : poses) {
    for (const ToolPose& goal : poses) {
      const PathRequest request{.start = start, .goal = goal, .focus = kFocus};
      check.asks(words(request));
      const auto path = subject.planner->plan(request);
      if (path) {
        check_sound(*path, request, check);
      } else {
        check.that(!path.error().text.empty(), "a refusal says why");
      }
    }
  }
}

}  // namespace

#define ARMATURE_LAW_ENTRY(Name, function, says) Law<PathSubject>{#Name, says, &function},
std::span<const Law<PathSubject>> path_laws() {
  static constexpr std::array kLaws{ARMATURE_PATH_LAWS(ARMATURE_LAW_ENTRY)};
  return kLaws;
}

}  // namespace armature
