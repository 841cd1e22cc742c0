// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/files/frame_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "armature/robot/files/calibrated_frame.hpp"
#include "armature/robot/files/robot_keys.hpp"
#include "armature/robot/files/written_pose.hpp"
#include "armature/robot/geometry/rotation.hpp"

namespace armature {
namespace {

using config::MapReader;
using config::Node;
using config::Problems;
using Eigen::Vector3d;

/// A frame as it was written, and the node that names its parent.
struct ReadFrame {
  NamedFrame frame;
  const Node* parent = nullptr;
};

/// What a calibration found is not stated again beside it: which of them would count?
void take_calibrated(MapReader& map, const Node& path, ReadFrame& result, Problems& problems) {
  const auto keep_one = [&](const char* key) {
    if (!map.node(key)) return;
    map.problem(key,
                fmt::format("'{}' and 'calibrated' state the same; keep one", map.written(key)));
  };
  keep_one("translation_m");
  if (!result.parent) return;  // which is noted
  const auto found =
      read_calibrated_frame(path, result.parent->text(), result.frame.name, problems);
  if (!found) return;
  result.frame.parent_T_frame.translation() = found->translation;
  if (!found->rotation) return;
  keep_one("rpy_deg");
  result.frame.parent_T_frame.linear() = found->rotation->toRotationMatrix();
}

ReadFrame read_frame(const Node::Entry& entry, Problems& problems) {
  MapReader map{entry.value, fmt::format("frame '{}'", entry.key), frame_keys(), problems};
  ReadFrame result;
  result.frame.name = entry.key;
  result.parent = map.node("parent");
  result.frame.parent_T_frame.translation() =
      read_vector(map, "translation_m").value_or(Vector3d::Zero());
  if (const auto rpy = read_vector(map, "rpy_deg")) {
    result.frame.parent_T_frame.linear() = rotation_from_rpy(*rpy);
  }
  if (const Node* path = map.node("calibrated")) take_calibrated(map, *path, result, problems);
  map.finish();
  return result;
}

/// Follows a frame's parents down to one that is there already.
class ParentResolver {
 public:
  ParentResolver(const std::vector<ReadFrame>& frames, const ParentNames& parents,
                 Problems& problems)
      : frames_(frames), parents_(parents), problems_(problems) {}

  NamedFrame resolve(const ReadFrame& frame) {
    NamedFrame result = frame.frame;
    std::vector<std::string> way{frame.frame.name};
    const ReadFrame* at = &frame;
    while (at && at->parent) {
      const std::string& parent = at->parent->text();
      if (const auto found = parents_.find(parent)) {
        result.parent_joint = found->joint;
        result.parent_T_frame = found->joint_T_parent * result.parent_T_frame;
        return result;
      }
      const bool circle = std::ranges::find(way, parent) != way.end();
      way.push_back(parent);
      if (circle) {
        problems_.add(frame.parent->origin(),
                      fmt::format("frames in a circle: {}", fmt::join(way, " -> ")));
        return result;
      }
      at = find(*at->parent);
      if (at) result.parent_T_frame = at->frame.parent_T_frame * result.parent_T_frame;
    }
    return result;
  }

 private:
  const ReadFrame* find(const Node& parent) {
    const auto name = [](const ReadFrame& read) { return read.frame.name; };
    const auto found = std::ranges::find(frames_, parent.text(), name);
    if (found != frames_.end()) return &*found;
    std::vector<std::string> names;
    std::ranges::transform(frames_, std::back_inserter(names), name);
    parents_.refuse(parent, names, problems_);
    return nullptr;
  }

  const std::vector<ReadFrame>& frames_;
  const ParentNames& parents_;
  Problems& problems_;
};

}  // namespace

std::vector<NamedFrame> read_frames(const Node& map, const ParentNames& parents,
                                    Problems& problems) {
  if (map.kind() != Node::Kind::map) {
    problems.add(map.origin(),
                 fmt::format("'frames' must be a map of frames, not {}", map.describe()));
    return {};
  }
  const auto has = [](const auto& named, const std::string& name) {
    return std::ranges::any_of(named, [&](const auto& one) { return one.name == name; });
  };
  std::vector<ReadFrame> read;
  for (const Node::Entry& entry : map.entries()) {
    read.push_back(read_frame(entry, problems));
    if (has(parents.frames, entry.key))
      problems.add(entry.key_origin,
                   fmt::format("'{}' is the name of a link; a frame needs its own", entry.key));
    if (entry.key == "base" || has(parents.joints, entry.key))
      problems.add(entry.key_origin,
                   fmt::format("'{}' is the name of a joint or of the base; a frame needs its own",
                               entry.key));
  }
  std::vector<NamedFrame> frames;
  ParentResolver resolver{read, parents, problems};
  for (const ReadFrame& frame : read) frames.push_back(resolver.resolve(frame));
  return frames;
}

}  // namespace armature
