// SPDX-License-Identifier: Apache-2.0
#include "calculate/calibrate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <ctime>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "armature/calibration/hand_eye.hpp"
#include "armature/calibration/pivot.hpp"
#include "armature/calibration/recorded_poses.hpp"
#include "armature/config/document.hpp"
#include "armature/runtime/reporting/write_atomically.hpp"
#include "armature/values/angles.hpp"
#include "armature/values/json_text.hpp"
#include "date_text.hpp"
#include "exit_code.hpp"
#include "readable_json.hpp"
#include "standard_output.hpp"

namespace armature {
namespace {

using config::Node;
using Json = nlohmann::ordered_json;

/// For people: four digits are enough.
double rounded(double value) { return std::stod(fmt::format("{:.4g}", value)); }
double mm(double m) { return rounded(1e3 * m); }
double deg(double rad) { return rounded(rad / kRadPerDegree); }

Json list(const auto& vector) {
  Json numbers = Json::array();
  for (const double number : vector) numbers.push_back(number);
  return numbers;
}

Json transform(const Eigen::Isometry3d& pose) {
  return {{"translation_m", list(pose.translation())},
          {"quaternion_xyzw", list(Eigen::Quaterniond{pose.linear()}.normalized().coeffs())}};
}

Node to_node(const Json& json) {
  if (json.is_array()) {
    std::vector<Node> items;
    for (const Json& item : json) items.push_back(to_node(item));
    return Node::sequence(std::move(items), {});
  }
  if (json.is_object()) {
    std::vector<Node::Entry> entries;
    for (const auto& [key, value] : json.items()) entries.push_back({key, {}, to_node(value)});
    return Node::map(std::move(entries), {});
  }
  return Node::scalar(json.is_string() ? json.get<std::string>() : json_text(json), false, {});
}

/// The robot whose joints are told, with the flange for its tool.
std::optional<RobotModel> load_flange(const CalibrationOptions& options) {
  if (options.arm.robot.empty()) return std::nullopt;
  ArmChoice arm = options.arm;
  if (arm.tip.empty()) arm.tip = "flange";
  return load_arm(arm);
}

std::string flange_name(const CalibrationOptions& options) {
  return options.arm.tip.empty() ? "flange" : options.arm.tip;
}

/// What every calibration says of itself.
Json head(const char* kind, const char* method, const CalibrationOptions& options,
          std::size_t poses) {
  Json json{{"armature_calibration", 1}, {"kind", kind}, {"method", method}};
  json["date_utc"] = date_text(utc(std::time(nullptr)), "%Y-%m-%dT%H:%M:%SZ");
  json["poses_file"] = options.poses;
  if (!options.arm.robot.empty()) json["robot_file"] = options.arm.robot;
  json["poses"] = poses;
  return json;
}

[[noreturn]] void refuse_poses(const CalibrationOptions& options, const Reason& reason) {
  throw std::runtime_error{fmt::format("{}: {}", options.poses, reason.text)};
}

/// The file to write; none: the result goes to standard output.
std::optional<std::string> file_of(const CalibrationOptions& options) {
  return options.output == "-" ? std::nullopt : options.output;
}

/// `hint`: how a robot file takes it.
int deliver(const Json& json, const CalibrationOptions& options, const std::string& hint) {
  if (options.json && options.output == "-") {
    throw InvalidChoice("--json and '-o -' both print on standard output; leave one out");
  }
  const std::string yaml = fmt::format("# For a robot file: frames: {{{}}}\n{}", hint,
                                       config::to_yaml(to_node(json), false));
  const std::optional<std::string> file = file_of(options);
  if (file) {
    for (const auto& [read, what] :
         {std::pair{options.poses, "the recording"}, {options.arm.robot, "the robot file"}}) {
      std::error_code none;
      if (!std::filesystem::equivalent(*file, read, none)) continue;
      throw InvalidChoice(
          fmt::format("-o {}: that is {}; give the result another name", *file, what));
    }
    write_atomically(*file, yaml, FileUse::named_by_user);
    fmt::print(stderr, "{}: {} poses, {} mm rms remain\n", *file, json["poses"].get<int>(),
               json["residual"]["rms_mm"].get<double>());
  }
  if (options.json) print_out("{}\n", readable(json));
  if (!file && !options.json) print_out("{}", yaml);
  return kOk;
}

std::string calibrated(const std::string& frame, const std::string& parent,
                       const CalibrationOptions& options) {
  return fmt::format("{}: {{parent: {}, calibrated: {}}}", frame, parent,
                     file_of(options).value_or("THIS FILE"));
}

/// Where the error is told: a stated point, or the middle of the recorded bodies.
Eigen::Vector3d point_of_interest(const CalibrationOptions& options,
                                  const std::vector<HandEyePose>& poses, const HandEye& found) {
  if (!options.at_m.empty()) return {options.at_m[0], options.at_m[1], options.at_m[2]};
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const HandEyePose& pose : poses) {
    sum += (pose.base_T_flange * found.flange_T_body).translation();
  }
  return sum / static_cast<double>(poses.size());
}

Json expected(const PointError& error) {
  return {{"rms_mm", mm(error.rms_m)}, {"bound95_mm", mm(error.bound95_m)}};
}

Json hand_eye_json(const HandEye& found, const std::vector<HandEyePose>& poses,
                   const CalibrationOptions& options) {
  Json json = head("hand_eye",
                   "base_T_flange flange_T_body = base_T_tracker tracker_T_body: Shah 2013, then "
                   "least squares weighed by noise",
                   options, poses.size());
  json[fmt::format("{}_T_{}", flange_name(options), options.body)] = transform(found.flange_T_body);
  json["base_T_" + options.tracker] = transform(found.base_T_tracker);
  json["residual"] = {{"rms_mm", mm(found.residual_rms_m)},
                      {"rms_deg", deg(found.residual_rms_rad)},
                      {"worst_pose", found.worst_pose + 1},
                      {"worst_mm", mm(found.worst_m)},
                      {"worst_deg", deg(found.worst_rad)}};
  json["noise_per_axis"] = {{"from", options.noise.empty() ? "residuals" : "stated"},
                            {"position_mm", mm(found.noise.position_m)},
                            {"rotation_deg", deg(found.noise.rotation_rad)}};
  json["orientation_spread_deg"] = deg(found.spread_rad);
  const Eigen::Vector3d point = point_of_interest(options, poses, found);
  Json at{{"point_of_base_m",
           Json::array({rounded(point.x()), rounded(point.y()), rounded(point.z())})}};
  at.update(expected(found.error_at(point)));
  json["expected_error"] = at;
  json["expected_error_of_" + options.body] =
      expected(found.body_error_at(found.flange_T_body.translation()));
  return json;
}

void check(const CalibrationOptions& options) {
  constexpr double kFarthest_m = 1000, kMaxNoise = 1000;
  for (const double coordinate : options.at_m) {
    if (std::abs(coordinate) <= kFarthest_m) continue;  // false for NaN
    throw InvalidChoice(
        fmt::format("--at is a point in metres, at most {:g} from the base; {:g} "
                    "is none",
                    kFarthest_m, coordinate));
  }
  for (const double noise : options.noise) {
    if (noise > 0 && noise <= kMaxNoise) continue;
    throw InvalidChoice(
        fmt::format("--noise must be positive, at most {:g}; {:g} is not", kMaxNoise, noise));
  }
}

/// A name becomes part of keys of a YAML file and names a frame of a robot file.
struct FrameName {
  const char* option;
  std::string name;
};

void expect_name(const FrameName& frame) {
  const auto in_a_name = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.' || c == '/';
  };
  if (!frame.name.empty() && std::ranges::all_of(frame.name, in_a_name)) return;
  throw InvalidChoice(
      fmt::format("{} is a frame's name of letters, digits, '_', '-', '.' and "
                  "'/'; {} is none",
                  frame.option, config::in_quotes(frame.name)));
}

/// `named` will stand in a robot file beside its base, its flange and, where it is known, its
/// joints.
void check(const CalibrationOptions& options, const std::optional<RobotModel>& robot,
           const std::vector<FrameName>& named) {
  std::vector<FrameName> taken{{"the robot's base", "base"}, {"--tip", flange_name(options)}};
  expect_name(taken.back());
  if (robot) {
    for (const Joint& joint : robot->joints())
      taken.push_back({"a joint of the robot", joint.name});
  }
  for (const FrameName& frame : named) {
    expect_name(frame);
    const auto other = std::ranges::find(taken, frame.name, &FrameName::name);
    if (other != taken.end()) {
      throw InvalidChoice(fmt::format("{} and {} are both called '{}'; a frame's name is its own",
                                      other->option, frame.option, frame.name));
    }
    taken.push_back(frame);
  }
}

}  // namespace

int run_hand_eye_calibration(const CalibrationOptions& options) {
  check(options);
  const auto robot = load_flange(options);
  check(options, robot, {{"--body", options.body}, {"--tracker", options.tracker}});
  const auto poses = read_hand_eye_poses(options.poses, robot ? &*robot : nullptr);
  HandEyeOptions how;
  if (!options.noise.empty()) {
    how.noise = PoseNoise{1e-3 * options.noise[0], kRadPerDegree * options.noise[1]};
  }
  const auto found = calibrate_hand_eye(poses, how);
  if (!found) refuse_poses(options, found.error());
  return deliver(hand_eye_json(*found, poses, options), options,
                 calibrated(options.body, flange_name(options), options) + ", " +
                     calibrated(options.tracker, "base", options));
}

int run_tool_calibration(const CalibrationOptions& options) {
  const auto robot = load_flange(options);
  const ToolPoses poses = read_tool_poses(options.poses, robot ? &*robot : nullptr);
  std::vector<FrameName> named{{"--tool", options.tool}};
  if (poses.is_tracked) {
    named = {{"--tracker", options.tracker}, {"--body", options.body}, {"--tool", options.tool}};
  }
  check(options, robot, named);
  const auto found = calibrate_pivot(poses.fixed_T_body);
  if (!found) refuse_poses(options, found.error());
  const std::string parent = poses.is_tracked ? options.body : flange_name(options);
  Json json =
      head("tool", "least squares of one fixed point, the tip", options, poses.fixed_T_body.size());
  json[parent + "_T_" + options.tool] = {{"translation_m", list(found->tip)}};
  json[(poses.is_tracked ? options.tracker : "base") + "_T_point"] = {
      {"translation_m", list(found->point)}};
  json["residual"] = {{"rms_mm", mm(found->residual_rms_m)},
                      {"worst_pose", found->worst_pose + 1},
                      {"worst_mm", mm(found->worst_m)}};
  json["orientation_spread_deg"] = deg(found->spread_rad);
  json["expected_error"] = expected(found->tip_error);
  return deliver(json, options, calibrated(options.tool, parent, options));
}

}  // namespace armature
