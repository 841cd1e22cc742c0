// SPDX-License-Identifier: Apache-2.0
#include "workspace/workspace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "armature/plot/chart.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/robot/kinematics/locked_joints.hpp"
#include "armature/runtime/plugins/running_component.hpp"
#include "armature/runtime/reporting/output_folder.hpp"
#include "armature/runtime/reporting/write_atomically.hpp"
#include "armature/values/json_text.hpp"
#include "exit_code.hpp"
#include "standard_output.hpp"
#include "workspace/workspace_points.hpp"

namespace armature {
namespace {

using Eigen::Vector3d;

struct Extent {
  Vector3d lower = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d upper = -lower;
};

Extent extent_of(const Workspace& workspace) {
  Extent extent;
  for (const ReachedPoint& point : workspace.points) {
    extent.lower = extent.lower.cwiseMin(point.position);
    extent.upper = extent.upper.cwiseMax(point.position);
  }
  return extent;
}

RemoteCentre centre_of(const RobotModel& robot, const WorkspaceOptions& options) {
  if (!robot.shaft()) {
    throw InvalidChoice(
        fmt::format("robot '{}' names no shaft to go through an incision; state in "
                    "its file, for example, shaft: {{axis: z, length_mm: 250}}",
                    robot.name()));
  }
  const Vector3d point{options.incision_m.data()};
  if (!point.allFinite()) {
    throw InvalidChoice(
        fmt::format("--incision ({}, {}, {}) is not finite", point.x(), point.y(), point.z()));
  }
  const double length_mm = 1e3 * robot.shaft()->length;
  if (!(options.min_depth_mm > 0 && options.min_depth_mm < length_mm)) {
    throw InvalidChoice(
        fmt::format("--min-depth is {:g} mm, not between 0 and the {:g} mm of the "
                    "shaft of robot '{}'",
                    options.min_depth_mm, length_mm, robot.name()));
  }
  return {.point = point, .shaft = *robot.shaft()};
}

Workspace workspace_of(const RobotModel& robot, const RemoteCentre& centre,
                       const WorkspaceOptions& options) {
  PluginRegistry plugins;
  const RobotModel solver_model = without_locked_joints(robot);
  const PluginPtr<IkSolver> solver = make_solver(options.solver, solver_model, plugins);
  const RunningComponent running{options.solver.plugin, "solve", "plugin"};
  return workspace_about(centre, 1e-3 * options.min_depth_mm, robot, *solver, options.samples,
                         options.seed);
}

/// A slide without limits comes to everywhere; of a joint that turns one turn is all that there is.
void refuse_open_slides(const RobotModel& robot) {
  for (int i = 0; i < robot.dof(); ++i) {
    if (robot.is_revolute(i)) continue;
    if (std::isfinite(robot.lower()[i]) && std::isfinite(robot.upper()[i])) continue;
    const auto joint = static_cast<std::size_t>(robot.independent_joint(i));
    throw InvalidChoice(
        fmt::format("joint {} of robot '{}' slides without limits; state them in its file",
                    robot.joints()[joint].name, robot.name()));
  }
}

std::string csv_of(const RobotModel& robot, const Workspace& workspace) {
  std::string text = "x_m,y_m,z_m";
  for (const Joint& joint : robot.joints()) text += "," + joint.name;
  text += '\n';
  for (const ReachedPoint& point : workspace.points) {
    const Vector3d& p = point.position;
    text += fmt::format("{:.6f},{:.6f},{:.6f}", p.x(), p.y(), p.z());
    for (const double q : robot.to_all(point.q)) text += fmt::format(",{:.6f}", q);
    text += '\n';
  }
  return text;
}

/// The points as they look along an axis: one dot for each cell of a fine grid that has some.
plot::Curve seen(const Workspace& workspace, int across, int up, double cell_m) {
  std::set<std::array<long, 2>> cells;
  for (const ReachedPoint& point : workspace.points) {
    cells.insert(
        {std::lround(point.position[across] / cell_m), std::lround(point.position[up] / cell_m)});
  }
  plot::Curve curve{.in_legend = 0, .x = {}, .y = {}};
  for (const auto& [x, y] : cells) {
    curve.x.push_back(static_cast<double>(x) * cell_m);
    curve.y.push_back(static_cast<double>(y) * cell_m);
  }
  return curve;
}

std::string svg_of(const RobotModel& robot, const Workspace& workspace,
                   const std::optional<RemoteCentre>& centre) {
  constexpr double kCellsAcross = 90, kSmallestCell_m = 1e-6;  // a single point has no extent
  const Extent extent = extent_of(workspace);
  const double cell_m =
      std::max((extent.upper - extent.lower).maxCoeff() / kCellsAcross, kSmallestCell_m);
  plot::Chart chart{
      .title = fmt::format("Workspace of the tip of {}{}", robot.name(),
                           centre ? ", its shaft in the incision" : ""),
      .legend = {plot::dots_of(0, "reached")},
      .x = {.label = "x [m]"},
      .panels = {{.y = {.label = "y [m], from above"}, .curves = {seen(workspace, 0, 1, cell_m)}},
                 {.y = {.label = "z [m], from the side"},
                  .curves = {seen(workspace, 0, 2, cell_m)}}},
      .is_equal = true};
  if (centre) {
    chart.legend.push_back(plot::dots_of(1, "incision"));
    for (const int up : {1, 2}) {
      chart.panels[static_cast<std::size_t>(up - 1)].curves.push_back(
          {.in_legend = 1, .x = {centre->point.x()}, .y = {centre->point[up]}});
    }
  }
  return plot::to_svg(chart);
}

nlohmann::ordered_json figures_of(const Workspace& workspace,
                                  const std::optional<RemoteCentre>& centre,
                                  const WorkspaceOptions& options) {
  nlohmann::ordered_json told;
  told["seed"] = options.seed;
  told["tried"] = workspace.tried;
  told["reached"] = workspace.points.size();
  if (centre) {
    const double share = static_cast<double>(workspace.points.size()) /
                         static_cast<double>(std::max<std::size_t>(workspace.tried, 1));
    told["volume_litres"] = 1e3 * share * ball_volume(*centre, 1e-3 * options.min_depth_mm);
  }
  if (workspace.points.empty()) return told;
  const Extent extent = extent_of(workspace);
  for (const auto& [key, i] : {std::pair{"x_m", 0}, {"y_m", 1}, {"z_m", 2}}) {
    told[key] = {extent.lower[i], extent.upper[i]};
  }
  return told;
}

void print(const nlohmann::ordered_json& told) {
  for (const auto& [key, value] : told.items()) {
    if (value.is_array()) {
      print_out("  {:<14} {:.4f} to {:.4f}\n", key, value[0].get<double>(), value[1].get<double>());
    } else if (value.is_number_float()) {
      print_out("  {:<14} {:.4f}\n", key, value.get<double>());
    } else {
      print_out("  {:<14} {}\n", key, json_text(value));
    }
  }
}

}  // namespace

int run_workspace(const WorkspaceOptions& options) {
  const RobotModel robot = load_arm(options.arm);
  refuse_open_slides(robot);
  std::optional<RemoteCentre> centre;
  if (!options.incision_m.empty()) centre = centre_of(robot, options);
  if (!options.out.empty()) prepare_output_folder(options.out);
  const Workspace workspace = centre ? workspace_of(robot, *centre, options)
                                     : free_workspace(robot, options.samples, options.seed);
  const auto told = figures_of(workspace, centre, options);
  if (options.json) {
    print_out("{}\n", json_text(told));
  } else {
    print(told);
  }
  if (workspace.points.empty()) {
    fmt::print(stderr,
               "armature: the tip comes nowhere; is the incision within the arm's reach?\n");
    return kFailed;
  }
  if (options.out.empty()) return kOk;
  const std::filesystem::path folder{options.out};
  write_atomically(folder / "workspace.csv", csv_of(robot, workspace), FileUse::named_by_user);
  write_atomically(folder / "workspace.svg", svg_of(robot, workspace, centre),
                   FileUse::named_by_user);
  return kOk;
}

}  // namespace armature
