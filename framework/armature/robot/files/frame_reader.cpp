// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/files/frame_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

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

/// Follows a frame's parents down to a joint or the base.
class ParentResolver {
 public:
  ParentResolver(const std::vector<ReadFrame>& frames, const std::vector<Joint>& joints,
                 const std::vector<NamedFrame>& links, Problems& problems)
      : frames_(frames), joints_(joints), links_(links), problems_(problems) {}

  NamedFrame resolve(const ReadFrame& frame) {
    NamedFrame result = frame.frame;
    std::vector<std::string> way{frame.frame.name};
    const ReadFrame* at = &frame;
    while (at && at->parent) {
      const std::string& parent = at->parent->text();
      if (parent == "base") return result;
      if (const auto joint = std::ranges::find(joints_, parent, &Joint::name);
          joint != joints_.end()) {
        result.parent_joint = static_cast<int>(joint - joints_.begin());
        return result;
      }
      if (const auto link = std::ranges::find(links_, parent, &NamedFrame::name);
          link != links_.end()) {
        result.parent_joint = link->parent_joint;
        result.parent_T_frame = link->parent_T_frame * result.parent_T_frame;
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
    const auto found =
        std::ranges::find(frames_, parent.text(), [](const ReadFrame& f) { return f.frame.name; });
    if (found != frames_.end()) return &*found;
    std::vector<std::string> known{"base"};
    for (const Joint& joint : joints_) known.push_back(joint.name);
    for (const NamedFrame& link : links_) known.push_back(link.name);
    for (const ReadFrame& frame : frames_) known.push_back(frame.frame.name);
    problems_.add(parent.origin(), fmt::format("there is no joint or frame '{}'{}", parent.text(),
                                               config::did_you_mean(parent.text(), known)));
    return nullptr;
  }

  const std::vector<ReadFrame>& frames_;
  const std::vector<Joint>& joints_;
  const std::vector<NamedFrame>& links_;
  Problems& problems_;
};

}  // namespace

std::vector<NamedFrame> read_frames(const Node& map, const std::vector<Joint>& joints,
                                    const std::vector<NamedFrame>& links, Problems& problems) {
  if (map.kind() != Node::Kind::map) {
    problems.add(map.origin(),
                 fmt::format("'frames' must be a map of frames, not {}", map.describe()));
    return {};
  }
  std::vector<ReadFrame> read;
  for (const Node::Entry& entry : map.entries()) {
    read.push_back(read_frame(entry, problems));
    if (std::ranges::find(links, entry.key, &NamedFrame::name) != links.end())
      problems.add(entry.key_origin,
                   fmt::format("'{}' is the name of a link; a frame needs its own", entry.key));
    if (entry.key == "base" || std::ranges::find(joints, entry.key, &Joint::name) != joints.end())
      problems.add(entry.key_origin,
                   fmt::format("'{}' is the name of a joint or of the base; a frame needs its own",
                               entry.key));
  }
  std::vector<NamedFrame> frames;
  ParentResolver resolver{read, joints, links, problems};
  for (const ReadFrame& frame : read) frames.push_back(resolver.resolve(frame));
  return frames;
}

}  // namespace armature
