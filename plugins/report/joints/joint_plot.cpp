// SPDX-License-Identifier: Apache-2.0
#include "joint_plot.hpp"

#include <cstddef>
#include <limits>
#include <vector>

namespace armature::report::joints {
namespace {

/// Of every joint.
struct Quantity {
  const char *name, *per_time;
  double min_span;  // [rad] or [m], where need be per second
};
constexpr Quantity kQuantities[]{{"joint position", "", 1e-3},
                                 {"joint speed", "/s", 1e-3},
                                 {"joint error, measured - reference", "", 1e-6}};
constexpr const char* kToolErrors[]{"position error of the tool against the goal [m]",
                                    "orientation error of the tool against the goal [rad]"};

/// Of the joints with this unit; curve `first` is that of the first joint.
plot::Panel panel_of(const Quantity& quantity, const std::string& unit,
                     const std::vector<Joint>& joints, std::size_t first,
                     const Envelope& envelope) {
  plot::Panel panel{
      .y = {.label = std::string{quantity.name} + " [" + unit + quantity.per_time + "]",
            .min_span = quantity.min_span}};
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (unit_of(joints[j]) == unit) panel.curves.push_back(envelope.curve(first + j, j));
  }
  return panel;
}

}  // namespace

JointPlot::JointPlot(const RobotModel& model)
    : model_{model},
      envelope_{std::size(kQuantities) * model.joints().size() + std::size(kToolErrors)} {}

void JointPlot::add(const JointRow& row) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const Eigen::Index joints = row.position.size();
  std::vector<double> values;
  for (const JointVector& of_all : {row.position, row.speed, row.error()}) {
    for (Eigen::Index j = 0; j < joints; ++j) {
      values.push_back(of_all.size() == joints ? of_all[j] : kNone);
    }
  }
  values.push_back(row.goal ? row.goal->position_m : kNone);
  values.push_back(row.goal ? row.goal->angle_rad : kNone);
  envelope_.add(to_seconds(row.since_start), values);
}

std::string JointPlot::svg() const {
  const std::vector<Joint>& joints = model_.joints();
  plot::Chart chart{.title = "The joints of " + model_.name(),
                    .x = {.label = "time [s]", .min_span = 0.1}};
  for (std::size_t j = 0; j < joints.size(); ++j) {
    chart.legend.push_back(plot::line_of(j, joints[j].name));
  }
  chart.legend.push_back(plot::black_line("tool"));
  std::size_t next = 0;
  for (const Quantity& quantity : kQuantities) {
    for (const char* unit : {"rad", "m"}) {
      chart.panels.push_back(panel_of(quantity, unit, joints, next, envelope_));
    }
    next += joints.size();
  }
  constexpr double kMinError = 1e-9;  // [m] or [rad]: what the table still tells
  for (const char* title : kToolErrors) {
    chart.panels.push_back({.y = {.label = title, .is_logarithmic = true, .min_span = kMinError},
                            .curves = {envelope_.curve(next++, joints.size())}});
  }
  return plot::to_svg(chart);
}

}  // namespace armature::report::joints
