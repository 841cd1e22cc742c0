// SPDX-License-Identifier: Apache-2.0
// Wang, Guan, Cao: the master manipulator of a urology robot. In the paper's millimetres.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "armature/kinds/ik/ik.hpp"
#include "armature/kinds/trajectory/trajectory_planner.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "bench/random_joints.hpp"
#include "reproduce/papers.hpp"
#include "reproduce/plugins.hpp"

namespace armature::reproduce {
namespace {

constexpr int kSlide = 2;
constexpr std::array kJoints{"theta1", "theta2", "d3", "theta4", "theta5", "theta6"};

/// What a value of joint `i` in SI units is multiplied with for the paper's.
double papers_unit(int i) { return i == kSlide ? 1e3 : 1; }

JointVector joints_of(const Numbers& numbers) {
  JointVector q = numbers.numbers(6);
  q[kSlide] *= 1e-3;
  return q;
}

class Master {
 public:
  explicit Master(const Numbers& numbers)
      : numbers_{numbers},
        solver_{plugins_.get<IkSolver>("ik/rrp_zyz", "", model_)},
        a_{joints_of(numbers["q_A"])},
        b_{joints_of(numbers["q_B"])},
        motion_{planned()} {}

  /// The branch that is nearest to `near`.
  JointVector inverse(const Eigen::Isometry3d& pose, const JointVector& near) const {
    IkGoal goal;
    goal.pose = {pose.translation(), Eigen::Quaterniond{pose.linear()}};
    IkBranches found;
    IkState state;
    solver_.solve(goal, near, found, state);
    const IkBranch* nearest = std::min_element(
        found.begin(), found.end(), [&](const IkBranch& one, const IkBranch& other) {
          return (one.q - near).norm() < (other.q - near).norm();
        });
    return nearest == found.end() ? JointVector::Constant(6, std::nan("")) : nearest->q;
  }

  void add_ends(Results& results) const {
    add_end("A ", a_, results);
    add_end("B ", b_, results);
  }

  void add_peaks(Results& results) const {
    const double duration = numbers_["duration_s"].number();
    const JointState middle = at(duration / 2);
    // Of s = 10 x^3 - 15 x^4 + 6 x^5 the second derivative is greatest here.
    const JointState steepest = at(duration * (0.5 - std::sqrt(3) / 6));
    const JointVector jerk = motion_.jerk_at(motion_.start);
    for (int i = 0; i < 6; ++i) {
      const std::string joint = kJoints[static_cast<std::size_t>(i)];
      const double unit = papers_unit(i);
      results.value("table_3", joint + " speed", unit * middle.v[i]);
      results.value("table_3", joint + " acceleration", unit * steepest.a[i]);
      results.value("table_3", joint + " jerk at the ends", unit * jerk[i]);
    }
    add_tip(duration, results);
  }

  void add_poses(Results& results) const {
    constexpr int kPoses = 100;
    std::mt19937_64 random{1};
    std::vector<double> number, set[3], actual[3];
    double position = 0, angle = 0;
    for (int n = 1; n <= kPoses; ++n) {
      const JointVector q = bench::anywhere(model_, random);
      const Eigen::Isometry3d wanted = forward_kinematics(model_, q);
      const Eigen::Isometry3d got = forward_kinematics(model_, inverse(wanted, q));
      number.push_back(n);
      for (int axis = 0; axis < 3; ++axis) {
        set[axis].push_back(1e3 * wanted.translation()[axis]);
        actual[axis].push_back(1e3 * got.translation()[axis]);
      }
      position = worst(position, 1e3 * (wanted.translation() - got.translation()).norm());
      angle = worst(angle, Eigen::AngleAxisd{wanted.linear().transpose() * got.linear()}.angle());
    }
    results.value("poses", "largest position error", position);
    results.value("poses", "largest angle error", angle);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      results.curve("figure_4", axis, "actual", number, actual[axis]);
      results.curve("figure_4", axis, "set", number, set[axis], Results::Look::dots);
    }
  }

  void add_motion(Results& results) const {
    constexpr int kSamples = 200;
    const double duration = numbers_["duration_s"].number();
    std::vector<double> time;
    std::array<std::vector<double>, 6> q, v, a;
    for (int n = 0; n <= kSamples; ++n) {
      const double t = duration * n / kSamples;
      const JointState state = at(t);
      time.push_back(t);
      for (int i = 0; i < 6; ++i) {
        const auto joint = static_cast<std::size_t>(i);
        q[joint].push_back(papers_unit(i) * state.q[i]);
        v[joint].push_back(papers_unit(i) * state.v[i]);
        a[joint].push_back(papers_unit(i) * state.a[i]);
      }
    }
    for (std::size_t i = 0; i < 6; ++i) {
      const std::size_t panel = i == kSlide ? 1 : 0;
      results.curve("figure_5", panel, kJoints[i], time, q[i]);
      results.curve("figure_6", panel, kJoints[i], time, v[i]);
      results.curve("figure_7", panel, kJoints[i], time, a[i]);
    }
  }

 private:
  Trajectory planned() {
    const auto& planner = plugins_.get<TrajectoryPlanner>("trajectory/quintic", "");
    const JointVector zero = JointVector::Zero(6);
    return or_throw(
        planner.plan({.goal_id = 1,
                      .start = {},
                      .from = {a_, zero, zero},
                      .segments = {{{0, 1}, {a_, b_}, true, numbers_["duration_s"].number()}},
                      .max_velocity = model_.max_velocity(),
                      .max_acceleration = model_.max_acceleration()}),
        "trajectory/quintic");
  }
  JointState at(double t) const { return motion_.at(motion_.start + seconds(t)); }

  void add_end(const std::string& end, const JointVector& q, Results& results) const {
    const Eigen::Isometry3d pose = forward_kinematics(model_, q);
    const JointVector found = inverse(pose, q);
    for (int i = 0; i < 6; ++i) {
      results.value("table_2", end + kJoints[static_cast<std::size_t>(i)],
                    papers_unit(i) * found[i]);
    }
    results.value("table_2", end + "x", 1e3 * pose.translation().x());
    results.value("table_2", end + "y", 1e3 * pose.translation().y());
    results.value("table_2", end + "z", 1e3 * pose.translation().z());
  }

  /// By chords and differences of a millisecond.
  void add_tip(double duration, Results& results) const {
    constexpr double kStep_s = 1e-3;
    double way = 0, fastest = 0;
    Eigen::Vector3d before = forward_kinematics(model_, a_).translation();
    for (int n = 1; n <= std::lround(duration / kStep_s); ++n) {
      const Eigen::Vector3d here = forward_kinematics(model_, at(n * kStep_s).q).translation();
      way += (here - before).norm();
      fastest = worst(fastest, (here - before).norm() / kStep_s);
      before = here;
    }
    results.value("table_3", "way of the tip", 1e3 * way);
    results.value("table_3", "speed of the tip", 1e3 * fastest);
  }

  Numbers numbers_;
  RobotModel model_ = shipped_robot("master");
  Plugins plugins_;
  const IkSolver& solver_;
  JointVector a_, b_;
  Trajectory motion_;
};

}  // namespace

void compute_master(const Numbers& numbers, bool /*with_long*/, Results& results) {
  const Master master{numbers};
  master.add_ends(results);
  master.add_peaks(results);
  master.add_poses(results);
  master.add_motion(results);
}

}  // namespace armature::reproduce
