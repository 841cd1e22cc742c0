// SPDX-License-Identifier: Apache-2.0
#include "bench/plan/planners.hpp"

#include <algorithm>
#include <kdl/velocityprofile_trap.hpp>
#include <vector>

namespace armature::bench {
namespace {

class PluginPlanner final : public Planner {
 public:
  explicit PluginPlanner(const TrajectoryPlanner& planner) : planner_{planner} {}

  bool plan(const TrajectoryRequest& request) override {
    auto planned = planner_.plan(request);
    if (!planned) return false;
    trajectory_ = std::move(*planned);
    return true;
  }
  double duration_s() const override { return trajectory_.duration_s(); }
  double sample(double t) const override {
    const JointState state = trajectory_.at(trajectory_.start + seconds(t));
    return state.q[0] + state.v[0] + state.a[0];
  }

 private:
  const TrajectoryPlanner& planner_;
  Trajectory trajectory_;
};

class KdlTrapezoid final : public Planner {
 public:
  bool plan(const TrajectoryRequest& request) override {
    const auto& segments = request.segments;
    if (segments.size() != 1 || segments.front().q.size() != 2) return false;
    const JointVector &from = segments.front().q[0], &to = segments.front().q[1];
    const auto joints = static_cast<std::size_t>(from.size());
    profiles_.resize(joints);
    duration_s_ = 0;
    for (std::size_t i = 0; i < joints; ++i) {
      const auto j = static_cast<Eigen::Index>(i);
      profiles_[i].SetMax(request.max_velocity[j], request.max_acceleration[j]);
      profiles_[i].SetProfile(from[j], to[j]);
      duration_s_ = std::max(duration_s_, profiles_[i].Duration());
    }
    for (std::size_t i = 0; i < joints; ++i) {
      const auto j = static_cast<Eigen::Index>(i);
      profiles_[i].SetProfileDuration(from[j], to[j], duration_s_);
    }
    return true;
  }
  double duration_s() const override { return duration_s_; }
  double sample(double t) const override {
    double sum = 0;
    for (const auto& profile : profiles_) sum += profile.Pos(t) + profile.Vel(t) + profile.Acc(t);
    return sum;
  }

 private:
  std::vector<KDL::VelocityProfile_Trap> profiles_;
  double duration_s_ = 0;
};

}  // namespace

std::unique_ptr<Planner> plugin_planner(const TrajectoryPlanner& planner) {
  return std::make_unique<PluginPlanner>(planner);
}

std::unique_ptr<Planner> kdl_trapezoid() { return std::make_unique<KdlTrapezoid>(); }

}  // namespace armature::bench
