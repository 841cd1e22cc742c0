// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <string>

#include "armature/kinds/geometry_params.hpp"
#include "armature/kinds/zone_messages.hpp"
#include "armature/messages/geometry_msgs.hpp"
#include "armature/messages/header.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "marked_head.hpp"
#include "sim_marked_head_ports.hpp"

namespace armature::sim::marked_head {
namespace {

using Eigen::Vector3d;

std::vector<ForbiddenZone> vessels_of(const std::vector<double>& values, const Params& params) {
  if (values.size() % 7 != 0) {
    params.refuse({"vessels_mm"},
                  "'vessels_mm' has " + std::to_string(values.size()) +
                      " numbers; seven for each vessel are needed: from, to, radius");
  }
  std::vector<ForbiddenZone> vessels;
  for (std::size_t i = 0; i < values.size(); i += 7) {
    const double* v = values.data() + i;
    vessels.push_back(
        {"vessel " + std::to_string(i / 7 + 1), {v[0], v[1], v[2]}, {v[3], v[4], v[5]}, v[6]});
    if (v[6] < 0) {
      params.refuse({"vessels_mm"},
                    fmt::format("'vessels_mm' item {} is {:g}, but a vessel's radius is at least 0",
                                i + 7, 1e3 * v[6]));
    }
  }
  return vessels;
}

void add_points(const std::vector<Vector3d>& points, std::vector<msg::Point>& messages) {
  for (const Vector3d& point : points) assign(messages.emplace_back(), point);
}

}  // namespace

/// Tells plan, measured markers and truth once: the head stays where it is.
class MarkedHeadComponent final : public Component {
 public:
  explicit MarkedHeadComponent(Setup& setup)
      : Component{setup},
        parameters_{Parameters::read(setup.params())},
        head_{.markers = points_of(parameters_.markers, setup.params(), "markers_mm", 3,
                                   "at least three markers"),
              .entry = vector_of(parameters_.entry),
              .target = vector_of(parameters_.target),
              .vessels = vessels_of(parameters_.vessels, setup.params()),
              .robot_T_image = pose_of(parameters_.head, parameters_.head_rpy)},
        seed_{setup.seed()},
        ports_{setup} {
    setup.activate_every(seconds(0.1));
  }

  void step(Time now) override {
    if (published_) return;
    published_ = true;
    msg::NeedlePlan plan;
    write_header(plan.header_(), now, kImageFrame);
    add_points(head_.markers, plan.markers_());
    assign(plan.entry_(), head_.entry);
    assign(plan.target_(), head_.target);
    write_zones(head_.vessels, plan.forbidden_());
    const Vector3d middle = Vector3d::Zero();
    write_zones({{"head", middle, middle, parameters_.head_radius}}, plan.head_());
    ports_.plan.publish(plan);
    msg::MeasuredMarkers markers;
    write_header(markers.header_(), now, kBaseFrame);
    add_points(measured_points(head_, parameters_, seed_), markers.points_());
    ports_.markers.publish(markers);
    msg::TransformStamped truth;
    write_header(truth.header_(), now, kBaseFrame);
    truth.child_frame_id_() = kImageFrame;
    assign(truth.transform_(), head_.robot_T_image);
    ports_.truth.publish(truth);
  }

 private:
  Parameters parameters_;
  MarkedHead head_;
  std::uint64_t seed_;
  bool published_ = false;
  Ports ports_;
};

}  // namespace armature::sim::marked_head

ARMATURE_PLUGIN(armature::sim::marked_head::MarkedHeadComponent);
