// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/way.hpp"

#include <fmt/core.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "armature/kinds/trajectory/legs.hpp"
#include "armature/robot/trajectories/short_trajectory.hpp"

namespace armature {
namespace {

constexpr std::size_t kKept = 4;       // drives: the newest may not have been taken over yet
constexpr double kSamePlace_s = 1e-6;  // as of retiming
constexpr double kSame = 1e-6;         // [rad] or [m], and of velocities

bool rests(const Trajectory& trajectory, double t) {
  return at_rest(state_at(trajectory.view(), t));
}

int stops_behind(const Trajectory& way, double place_s) {
  int stops = 0;
  for (double at = place_s; at < way.duration_s() - kSamePlace_s; ++stops) {
    at = next_rest_s(way, at);
  }
  return stops;
}

/// [s] Where the way is nearest to `q` between two places.
double nearest_s(const Trajectory& way, const JointVector& q, double begin, double end) {
  const auto off = [&](double t) { return (state_at(way.view(), t).q - q).squaredNorm(); };
  constexpr int kSamples = 2000, kSteps = 60;
  const double step = (end - begin) / kSamples;
  double nearest = begin;
  for (int i = 1; i <= kSamples; ++i) {
    if (off(begin + i * step) < off(nearest)) nearest = begin + i * step;
  }
  double from = std::max(begin, nearest - step), to = std::min(end, nearest + step);
  for (int i = 0; i < kSteps; ++i) {
    const double third = (to - from) / 3;
    const bool nearer_to_from = off(from + third) < off(to - third);
    from += nearer_to_from ? 0 : third;
    to -= nearer_to_from ? third : 0;
  }
  return (from + to) / 2;
}

/// A stop behind what neither moves nor lasts is none.
int stops_of(const std::vector<JointSegment>& segments) {
  int stops = 0;
  bool goes = false;
  for (const JointSegment& segment : segments) {
    goes = goes || moves(segment) || segment.duration_s;
    if (!segment.stop_at_end) continue;
    stops += goes ? 1 : 0;
    goes = false;
  }
  return stops;
}

WayLegResult no_leg(std::string reason) {
  return tl::unexpected{PlanFailure{.stage = "path", .reason = std::move(reason)}};
}

}  // namespace

WayLeg Ways::keep(Drive drive) {
  WayLeg leg{drive.trajectory, stops_behind(drive.way.trajectory(), drive.to_s)};
  if (drives_.size() == kKept) drives_.pop_front();
  drives_.push_back(std::move(drive));
  return leg;
}

WayLegResult Ways::begin(const Plan& plan, bool stepwise) {
  const Trajectory& whole = plan.trajectory;
  const int stops = stops_of(plan.joint_path);
  if (stepwise && stops_behind(whole, 0) < stops) {
    return tl::unexpected{
        PlanFailure{.stage = "trajectory",
                    .reason = fmt::format("it rests {} times, and its path stops {} times",
                                          stops_behind(whole, 0), stops)}};
  }
  const double end_s = whole.duration_s();
  const double to_s = stepwise ? next_rest_s(whole, 0) : end_s;
  Drive drive{.way = {.onward = whole, .back = reversed(whole)}, .to_s = to_s, .aims_s = to_s};
  drive.trajectory = to_s < end_s ? part(whole, 0, to_s) : whole;
  return keep(std::move(drive));
}

const Ways::Drive* Ways::find(const PlanRequest& request) const {
  for (auto drive = drives_.rbegin(); drive != drives_.rend(); ++drive) {
    const JointState there =
        drive->trajectory.at(drive->trajectory.start + (request.start - request.since));
    const bool same = (there.q - request.from.q).cwiseAbs().maxCoeff() < kSame &&
                      (there.v - request.from.v).cwiseAbs().maxCoeff() < kSame;
    if (same) return &*drive;
  }
  return nullptr;
}

/// What leads to the way, before what goes along it.
void Ways::join(const Trajectory& to_way, Drive& drive) {
  const double lasts = to_way.duration_s();
  if (lasts == 0) return;
  drive.trajectory = followed_by(to_way, drive.trajectory);
  drive.joins_s = lasts;
  drive.ramp_s += lasts;
}

double Ways::Drive::place_at(double t) const {
  if (t >= ramp_s) return std::min(ramp_end_s + t - ramp_s, to_s);
  return nearest_s(way.trajectory(), state_at(trajectory.view(), t).q, from_s, ramp_end_s);
}

Ways::Drive Ways::paused(const Drive& drive, double t) const {
  Drive next = drive;
  next.brakes = true;
  if (drive.brakes) {
    next.trajectory = part(drive.trajectory, t, drive.trajectory.duration_s());
    return next;
  }
  const double on_way_s = std::max(t, drive.joins_s);
  const Retimed stop = brake(drive.trajectory, on_way_s, limits_);
  next.trajectory = followed_by(part(drive.trajectory, t, on_way_s), stop.trajectory);
  next.to_s = drive.place_at(stop.place_s);
  return next;
}

Expected<Ways::Drive> Ways::gone_on(const Drive& drive, bool back, bool stepwise) const {
  Drive next{.way = drive.way};
  next.way.forwards = !back;
  const Trajectory& way = next.way.trajectory();
  const bool turned = drive.way.forwards != next.way.forwards;
  next.from_s = turned ? way.duration_s() - drive.to_s : drive.to_s;
  const bool goes_on = drive.brakes && !turned;
  if (!goes_on && next.from_s > way.duration_s() - kSamePlace_s) {
    return refuse(back ? "the arm stands where its way began" : "nothing is left of the way");
  }
  const double stop_s = next_rest_s(way, next.from_s);
  next.to_s = !stepwise ? way.duration_s() : goes_on ? drive.aims_s : stop_s;
  next.aims_s = next.to_s;
  if (!rests(way, next.to_s)) return refuse("the way began while the arm moved");
  if (rests(way, next.from_s)) {
    next.ramp_end_s = next.from_s;
    next.trajectory = part(way, next.from_s, next.to_s);
    return next;
  }
  const Retimed on = speed_up(way, next.from_s, stop_s, limits_);
  next.ramp_s = on.ramp_s;
  next.ramp_end_s = on.place_s;
  next.trajectory = on.trajectory;
  if (stop_s < next.to_s) {
    next.trajectory = followed_by(on.trajectory, part(way, stop_s, next.to_s));
  }
  return next;
}

Expected<Ways::Drive> Ways::joined(const JointVector& q) const {
  double off_most = INFINITY;
  for (auto drive = drives_.rbegin(); drive != drives_.rend(); ++drive) {
    const Trajectory& way = drive->way.trajectory();
    const double place_s = nearest_s(way, q, 0, way.duration_s());
    const JointVector there = state_at(way.view(), place_s).q;
    const double off = (q - there).cwiseAbs().cwiseQuotient(join_within_).maxCoeff();
    off_most = std::min(off_most, off);
    if (off > 1) continue;
    Drive on{.way = drive->way, .to_s = place_s};
    on.trajectory = to_trajectory(
        short_move(q, there, limits_.max_velocity, limits_.max_acceleration, {}, 0).view());
    return on;
  }
  if (drives_.empty()) return refuse("the arm is on no planned way");
  return refuse(fmt::format(
      "the arm is beside its way, by {:.1f} times as much as it may join it again from", off_most));
}

WayLegResult Ways::change(MotionMode mode, bool stepwise, const PlanRequest& request) {
  const Drive* drive = find(request);
  const bool back = mode == MotionMode::retrace;
  if (!drive && !back) return no_leg("the arm is on no planned way");
  Drive next;
  if (mode == MotionMode::pause) {
    next = paused(*drive, to_seconds(request.start - request.since));
  } else {
    if (!at_rest(request.from)) return no_leg("the arm has not stopped yet");
    const auto from = drive ? Expected<Drive>{*drive} : joined(request.from.q);
    if (!from) return no_leg(from.error().text);
    auto on = gone_on(*from, back, stepwise);
    if (!on) return no_leg(on.error().text);
    next = std::move(*on);
    if (!drive) join(from->trajectory, next);
  }
  next.trajectory.start = request.start;
  next.trajectory.goal_id = request.goal_id;
  return keep(std::move(next));
}

}  // namespace armature
