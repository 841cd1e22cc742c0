// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/files/calibrated_frame.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>

#include "armature/config/document.hpp"
#include "armature/config/key_rows.hpp"
#include "armature/config/source_text.hpp"
#include "armature/config/yaml_parser.hpp"
#include "armature/robot/files/written_pose.hpp"

namespace armature {
namespace {

using config::MapReader;
using config::Node;
using config::Problems;

std::optional<CalibratedFrame> read_transform(const Node& node, const std::string& name,
                                              Problems& problems) {
  using namespace config::rows;
  static const std::vector<config::KeySpec> kKeys{
      numbers("translation_m").count(3).also("translation_mm"),
      numbers("quaternion_xyzw").count(4).optional()};
  MapReader map{node, name, kKeys, problems};
  const auto translation = read_vector(map, "translation_m");
  const bool is_turned = map.node("quaternion_xyzw") != nullptr;
  const auto rotation = read_quaternion(map, "quaternion_xyzw");
  map.finish();
  if (!translation || (is_turned && !rotation)) return std::nullopt;
  return CalibratedFrame{*translation, rotation};
}

/// What else stands in the file is for people.
std::optional<CalibratedFrame> find_transform(const Node& document, const std::string& wanted,
                                              const Node& path, Problems& problems) {
  static const std::vector kKeys{config::format_key("armature_calibration")};
  MapReader map{document, "calibration", kKeys, problems};
  if (document.kind() != Node::Kind::map) return std::nullopt;
  map.integer("armature_calibration");
  if (const Node* transform = document.find(wanted)) {
    return read_transform(*transform, wanted, problems);
  }
  std::vector<std::string> held;
  for (const Node::Entry& entry : document.entries()) {
    if (entry.key.find("_T_") != std::string::npos) held.push_back(entry.key);
  }
  problems.add(path.origin(),
               fmt::format("'{}' holds {}, not {}", path.text(),
                           held.empty() ? "no transform" : fmt::format("{}", fmt::join(held, ", ")),
                           wanted));
  return std::nullopt;
}

}  // namespace

std::optional<CalibratedFrame> read_calibrated_frame(const Node& path, std::string_view parent,
                                                     std::string_view frame, Problems& problems) {
  if (path.kind() != Node::Kind::scalar || path.text().empty()) {
    problems.add(path.origin(), fmt::format("'calibrated' must be the path of a file that "
                                            "`armature calibrate` wrote, not {}",
                                            path.describe()));
    return std::nullopt;
  }
  try {
    const auto file = (config::folder_of(path.origin()) / path.text()).lexically_normal();
    const Node document =
        config::parse_document(config::read_source(file, path.origin()), file.string());
    return find_transform(document, fmt::format("{}_T_{}", parent, frame), path, problems);
  } catch (const config::ConfigError& error) {
    for (const config::Problem& problem : error.problems()) {
      problems.add(problem.origin, problem.message);
    }
    return std::nullopt;
  }
}

}  // namespace armature
