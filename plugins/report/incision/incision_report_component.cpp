// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/pose_in_base.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/robot/kinematics/remote_centre.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "report_incision_ports.hpp"

namespace armature::report::incision {
namespace {

constexpr Duration kPeriod = seconds(0.02);

Shaft shaft_of(const RobotModel& model) {
  if (model.shaft()) return *model.shaft();
  throw SetupError(
      fmt::format("robot {} names no shaft; state in its file, for example, shaft: "
                  "{{axis: z, length_mm: 250}}",
                  model.name()));
}

}  // namespace

class IncisionReport final : public Component {
 public:
  explicit IncisionReport(Setup& setup)
      : Component{setup},
        model_{robot_of(setup)},
        centre_{.shaft = shaft_of(model_)},
        ports_{setup} {
    setup.activate_every(kPeriod);
  }

  void step(Time) override {
    complaint_.clear();
    if (ports_.incision.fresh()) read(*ports_.incision.latest());
    for (std::size_t i = 0; i < ports_.measured_js.size(); ++i) read(ports_.measured_js[i]);
    if (complaint_.empty()) {
      healthy();
    } else {
      degraded(complaint_);
    }
  }

  void summarize(Summary& summary) const override {
    if (samples_ == 0 && not_known_ == 0) return;
    const auto metric = [&](const char* key, const char* title, double value_m) {
      if (not_known_ == 0) return summary.metric(key, title, 1e3 * value_m);
      summary.not_measured(
          key, title,
          fmt::format("samples that tell no distance of the shaft from the incision: {}",
                      not_known_));
    };
    metric("incision_deviation_mm", "shaft off the incision, at most [mm]", max_deviation_);
    metric("incision_deviation_rms_mm", "the same, rms [mm]",
           std::sqrt(squares_ / static_cast<double>(samples_)));
    metric("min_depth_mm", "depth of the tip, at least [mm]", min_depth_);
    metric("max_depth_mm", "at most [mm]", max_depth_);
  }

 private:
  void read(const msg::PointStamped& message) {
    const Eigen::Vector3d point = to_eigen(message.point_());
    const ReasonText wrong = defect_of_point(message.header_(), point, "the incision");
    if (!wrong.empty()) {
      complaint_ = wrong.view();
      return;
    }
    centre_.point = point;
    told_ = true;
  }

  void read(const msg::JointState& message) {
    if (!told_) return;
    const auto q = joints_of(model_, message);
    if (!q) {
      complaint_ = "measured_js: " + q.error().text;
      ++not_known_;
      return;
    }
    const Eigen::Isometry3d base_T_tool = forward_kinematics(model_, *q);
    const double deviation = centre_.deviation(base_T_tool), depth = centre_.depth(base_T_tool);
    if (!std::isfinite(deviation) || !std::isfinite(depth)) {
      complaint_ = "the shaft's distance from the incision is not finite";
      ++not_known_;
      return;
    }
    max_deviation_ = std::max(max_deviation_, deviation);
    squares_ += deviation * deviation;
    min_depth_ = std::min(min_depth_, depth);
    max_depth_ = std::max(max_depth_, depth);
    ++samples_;
  }

  RobotModel model_;
  RemoteCentre centre_;
  bool told_ = false;
  std::size_t samples_ = 0, not_known_ = 0;
  double max_deviation_ = 0, squares_ = 0;                       // [m], [m2]
  double min_depth_ = std::numeric_limits<double>::infinity();   // [m]
  double max_depth_ = -std::numeric_limits<double>::infinity();  // [m]
  std::string complaint_;
  Ports ports_;
};

}  // namespace armature::report::incision

ARMATURE_PLUGIN(armature::report::incision::IncisionReport);
