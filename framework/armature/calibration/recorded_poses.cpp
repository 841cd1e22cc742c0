// SPDX-License-Identifier: Apache-2.0
#include "armature/calibration/recorded_poses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "armature/config/key_rows.hpp"
#include "armature/config/reader.hpp"
#include "armature/config/source_text.hpp"
#include "armature/config/yaml_parser.hpp"
#include "armature/robot/files/written_pose.hpp"
#include "armature/robot/kinematics/kinematics.hpp"

namespace armature {
namespace {

using config::KeySpec;
using namespace config::rows;
using config::MapReader;
using config::Node;
using config::Origin;
using config::Problems;
using Eigen::Isometry3d;

/// `node`, which was read from a line by itself.
Node on_line(const Node& node, int line) {
  const auto there = [line](Origin origin) {
    origin.line = line;
    return origin;
  };
  switch (node.kind()) {
    case Node::Kind::null: {
      Node null = Node::null(there(node.origin()));
      null.set_text(node.text());
      return null;
    }
    case Node::Kind::scalar: return Node::scalar(node.text(), node.quoted(), there(node.origin()));
    case Node::Kind::sequence: {
      std::vector<Node> items;
      for (const Node& item : node.items()) items.push_back(on_line(item, line));
      return Node::sequence(std::move(items), there(node.origin()));
    }
    case Node::Kind::map: break;
  }
  std::vector<Node::Entry> entries;
  for (const Node::Entry& entry : node.entries()) {
    entries.push_back({entry.key, there(entry.key_origin), on_line(entry.value, line)});
  }
  return Node::map(std::move(entries), there(node.origin()));
}

bool says_nothing(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t\r");
  return first == std::string_view::npos || line[first] == '#';
}

/// The first line that is more than a comment; empty: there is none.
std::string_view first_line(std::string_view text) {
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    if (!says_nothing(line)) return line.substr(line.find_first_not_of(" \t\r"));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
  }
  return "";
}

/// JSON is YAML: each line by itself, so that a bad one does not hide the others.
std::vector<Node> records_of_lines(std::string_view text, const std::string& name,
                                   Problems& problems) {
  std::vector<Node> records;
  for (int number = 1; !text.empty(); ++number) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (says_nothing(line)) continue;
    try {
      records.push_back(on_line(config::parse_yaml(std::string{line}, name), number));
    } catch (const config::ConfigError& error) {
      for (const config::Problem& problem : error.problems()) {
        problems.add({name, number, problem.origin.column}, problem.message);
      }
    }
  }
  return records;
}

std::vector<Node> records_of_document(const Node& document, Problems& problems) {
  static const std::vector<KeySpec> kKeys{config::format_key("armature_poses"), section("poses")};
  MapReader map{document, "file of poses", kKeys, problems};
  map.integer("armature_poses");
  const Node* poses = map.node("poses");
  map.finish();
  if (!poses) return {};
  if (poses->kind() != Node::Kind::sequence) {
    map.problem("poses", fmt::format("'poses' must be a list, not {}", poses->describe()));
    return {};
  }
  return {poses->items().begin(), poses->items().end()};
}

std::vector<Node> records_in(const std::filesystem::path& file, Problems& problems) {
  std::string text = config::read_source(file, Origin{});
  const std::string name = file.string();
  if (constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
      text.starts_with(kByteOrderMark)) {
    text.erase(0, kByteOrderMark.size());
  }
  const std::string_view first = first_line(text);
  if (first.empty()) {
    problems.add({name, 1, 1},
                 "no poses; write a JSON object with 'joints', 'base_T_flange' or "
                 "'tracker_T_body' on each line, or YAML with 'armature_poses: 1' and 'poses:'");
    return {};
  }
  std::vector<Node> records =
      first.front() == '{' ? records_of_lines(text, name, problems)
                           : records_of_document(config::parse_document(text, name), problems);
  std::erase_if(records, [&](const Node& record) {
    if (record.kind() == Node::Kind::map) return false;
    problems.add(record.origin(), fmt::format("a pose must be a map, not {}", record.describe()));
    return true;
  });
  return records;
}

/// What one record says.
struct Record {
  std::optional<Isometry3d> base_T_flange, tracker_T_body;
  bool tells_flange = false, tells_body = false;  // rightly or not
};

std::optional<Isometry3d> flange_of_joints(const Node& joints, const RobotModel* robot,
                                           Problems& problems) {
  if (!robot) {
    problems.add(joints.origin(), "'joints' are those of a robot; name its file with --robot");
    return std::nullopt;
  }
  const auto all = config::to_numbers(joints, std::nullopt);
  if (!all) {
    problems.add(all.error().origin, "'joints' " + all.error().message);
    return std::nullopt;
  }
  const auto independent = robot->to_independent(std::span<const double>{*all});
  if (independent) return forward_kinematics(*robot, *independent);
  problems.add(joints.origin(), fmt::format("'joints': {}", independent.error().text));
  return std::nullopt;
}

Record read_record(const Node& node, const RobotModel* robot, Problems& problems) {
  static const std::vector<KeySpec> kKeys{section("joints").optional(),
                                          section("base_T_flange").optional(),
                                          section("tracker_T_body").optional()};
  MapReader map{node, "pose", kKeys, problems};
  const Node* joints = map.node("joints");
  const Node* flange = map.node("base_T_flange");
  const Node* body = map.node("tracker_T_body");
  map.finish();
  if (joints && flange) {
    map.problem("base_T_flange", "'joints' and 'base_T_flange' state the same; keep one");
  }
  Record record;
  record.tells_flange = joints || flange;
  record.tells_body = body;
  if (joints) record.base_T_flange = flange_of_joints(*joints, robot, problems);
  if (flange) record.base_T_flange = read_pose(*flange, "base_T_flange", problems);
  if (body) record.tracker_T_body = read_pose(*body, "tracker_T_body", problems);
  return record;
}

}  // namespace

std::vector<HandEyePose> read_hand_eye_poses(const std::filesystem::path& file,
                                             const RobotModel* robot) {
  Problems problems;
  std::vector<HandEyePose> poses;
  for (const Node& node : records_in(file, problems)) {
    const Record record = read_record(node, robot, problems);
    if (!record.tells_flange) {
      problems.add(node.origin(), "a pose for hand-eye needs 'joints' or 'base_T_flange'");
    }
    if (!record.tells_body) {
      problems.add(node.origin(), "a pose for hand-eye needs 'tracker_T_body'");
    }
    if (!record.base_T_flange || !record.tracker_T_body) continue;
    poses.push_back({*record.base_T_flange, *record.tracker_T_body});
  }
  problems.throw_if_any();
  return poses;
}

ToolPoses read_tool_poses(const std::filesystem::path& file, const RobotModel* robot) {
  Problems problems;
  ToolPoses poses;
  std::optional<bool> first_is_tracked;
  for (const Node& node : records_in(file, problems)) {
    const Record record = read_record(node, robot, problems);
    if (record.tells_flange == record.tells_body) {
      problems.add(node.origin(),
                   "a pose of a tool is one of 'joints', 'base_T_flange' and 'tracker_T_body'");
      continue;
    }
    poses.is_tracked = first_is_tracked.value_or(record.tells_body);
    first_is_tracked = poses.is_tracked;
    if (record.tells_body != poses.is_tracked) {
      problems.add(node.origin(), fmt::format("this pose is of the {}, the first one of the {}",
                                              record.tells_body ? "body" : "flange",
                                              poses.is_tracked ? "body" : "flange"));
    }
    const auto& pose = record.tells_body ? record.tracker_T_body : record.base_T_flange;
    if (pose) poses.fixed_T_body.push_back(*pose);
  }
  problems.throw_if_any();
  return poses;
}

}  // namespace armature
