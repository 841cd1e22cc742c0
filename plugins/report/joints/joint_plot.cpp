// SPDX-License-Identifier: Apache-2.0
#include "joint_plot.hpp"

#include <cstddef>
#include <limits>
#include <vector>

#include "plot.hpp"

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

Panel panel_of(const Quantity& quantity, const std::string& unit, const std::vector<Joint>& joints,
               std::size_t first) {
  Panel panel{.title = std::string{quantity.name} + " [" + unit + quantity.per_time + "]",
              .is_logarithmic = false,
              .min_span = quantity.min_span,
              .curves = {}};
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (unit_of(joints[j]) == unit) panel.curves.push_back({first + j, j});
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
  std::vector<Line> legend;
  for (std::size_t j = 0; j < joints.size(); ++j) legend.push_back(line_of(j, joints[j].name));
  legend.push_back(black_line("tool"));
  std::vector<Panel> panels;
  std::size_t next = 0;
  for (const Quantity& quantity : kQuantities) {
    for (const char* unit : {"rad", "m"}) panels.push_back(panel_of(quantity, unit, joints, next));
    next += joints.size();
  }
  constexpr double kMinError = 1e-9;  // [m] or [rad]: what the table still tells
  for (const char* title : kToolErrors) {
    panels.push_back({.title = title,
                      .is_logarithmic = true,
                      .min_span = kMinError,
                      .curves = {{next++, joints.size()}}});
  }
  return to_svg("The joints of " + model_.name(), legend, panels, envelope_);
}

}  // namespace armature::report::joints
