// SPDX-License-Identifier: Apache-2.0
// One line per thing, numbers with every digit:
//   reference.csv   ns, q..., v..., a...       of the independent joints, each sample
//   goals.csv       ns, goal id, state         each change
//   path.csv        goal id, position, direction
//   joint_path.csv  goal id, q...              of all joints
//   jerk.csv        goal id, greatest jerk     [rad/s3] of the planned trajectory
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <utility>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/messages/trajectory_msgs.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "test_recorder_parameters.hpp"

namespace armature::test::recorder {
namespace {

constexpr Duration kPeriod = seconds(0.02);

std::ofstream open(const Setup& setup, const char* file) {
  const std::filesystem::path folder = Parameters::read(setup.params()).folder;
  std::ofstream stream{folder / file};
  if (!stream) throw SetupError(fmt::format("cannot write into {}", folder.string()));
  return stream;
}

/// Of one joint's quintic c0 + ... + c5 t^5 for 0 <= t <= length: the jerk is a parabola.
double greatest_jerk(const double* c, double length) {
  const auto jerk = [&](double t) { return std::abs(6 * c[3] + t * (24 * c[4] + t * 60 * c[5])); };
  double greatest = std::max(jerk(0), jerk(length));
  if (c[5] != 0) greatest = std::max(greatest, jerk(std::clamp(-c[4] / (5 * c[5]), 0.0, length)));
  return greatest;
}

double greatest_jerk(const msg::QuinticTrajectory& trajectory) {
  const std::size_t dof = trajectory.joint_names_().size();
  const auto& knots = trajectory.knots_();
  double greatest = 0;
  for (std::size_t piece = 0; piece + 1 < knots.size(); ++piece) {
    for (std::size_t joint = 0; joint < dof; ++joint) {
      greatest = std::max(
          greatest, greatest_jerk(trajectory.coefficients_().data() + (piece * dof + joint) * 6,
                                  knots[piece + 1] - knots[piece]));
    }
  }
  return greatest;
}

}  // namespace

class Recorder : public Component {
 public:
  explicit Recorder(Setup& setup)
      : Component(setup),
        reference_{setup.input<msg::JointReference>("reference")},
        status_{setup.input<msg::MotionStatus>("status")},
        path_{setup.input<msg::ToolPath>("path")},
        joint_path_{setup.input<msg::JointTrajectory>("joint_path")},
        trajectory_{setup.input<msg::QuinticTrajectory>("trajectory")},
        reference_file_{open(setup, "reference.csv")},
        goals_file_{open(setup, "goals.csv")},
        path_file_{open(setup, "path.csv")},
        joint_path_file_{open(setup, "joint_path.csv")},
        jerk_file_{open(setup, "jerk.csv")} {
    setup.activate_every(kPeriod);
  }

  void step(Time) override {
    for (std::size_t i = 0; i < reference_.size(); ++i) write_reference(reference_[i]);
    for (std::size_t i = 0; i < status_.size(); ++i) write_status(status_[i]);
    // The three are published together, so that the same place in each queue is the same plan.
    for (std::size_t i = 0; i < path_.size(); ++i) write_plan(i);
  }

 private:
  void write_reference(const msg::JointReference& joints) {
    reference_file_ << fmt::format(
        "{},{:.17g},{:.17g},{:.17g}\n", stamp_of(joints.header_().stamp_()).ns,
        fmt::join(joints.position_(), ","), fmt::join(joints.velocity_(), ","),
        fmt::join(joints.acceleration_(), ","));
  }

  void write_status(const msg::MotionStatus& status) {
    const std::pair scenario{status.goal_id_(), static_cast<int>(status.state_())};
    if (scenario == last_story_) return;  // told again every now and then
    last_story_ = scenario;
    goals_file_ << fmt::format("{},{},{}\n", stamp_of(status.header_().stamp_()).ns, scenario.first,
                               scenario.second);
  }

  void write_plan(std::size_t i) {
    const std::uint64_t goal = path_[i].goal_id_();
    for (std::size_t k = 0; k < path_[i].position_().size(); ++k) {
      const auto& p = path_[i].position_()[k];
      const auto& d = path_[i].direction_()[k];
      path_file_ << fmt::format("{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n", goal,
                                p.x_(), p.y_(), p.z_(), d.x_(), d.y_(), d.z_());
    }
    for (const auto& point : joint_path_[i].points_()) {
      joint_path_file_ << fmt::format("{},{:.17g}\n", goal, fmt::join(point.positions_(), ","));
    }
    jerk_file_ << fmt::format("{},{:.17g}\n", goal, greatest_jerk(trajectory_[i]));
  }

  Input<msg::JointReference> reference_;
  Input<msg::MotionStatus> status_;
  Input<msg::ToolPath> path_;
  Input<msg::JointTrajectory> joint_path_;
  Input<msg::QuinticTrajectory> trajectory_;
  std::ofstream reference_file_, goals_file_, path_file_, joint_path_file_, jerk_file_;
  std::pair<std::uint64_t, int> last_story_{0, -1};
};

}  // namespace armature::test::recorder

ARMATURE_PLUGIN(armature::test::recorder::Recorder);
