// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/files/parent_names.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace armature {

std::optional<Parent> ParentNames::find(const std::string& name) const {
  const auto frame = std::ranges::find(frames, name, &NamedFrame::name);
  if (frame != frames.end()) return Parent{frame->parent_joint, frame->parent_T_frame};
  if (no_frames.contains(name)) return std::nullopt;
  if (name == "base") return Parent{};
  const auto joint = std::ranges::find(joints, name, &Joint::name);
  if (joint != joints.end()) return Parent{.joint = static_cast<int>(joint - joints.begin())};
  return std::nullopt;
}

void ParentNames::refuse(const config::Node& named, const std::vector<std::string>& more,
                         config::Problems& problems) const {
  if (is_unread) return;
  const std::string& name = named.text();
  const auto why = no_frames.find(name);
  if (why != no_frames.end()) {
    return problems.add(named.origin(), fmt::format("'{}' is {}", name, why->second));
  }
  std::vector<std::string> known{"base"};
  for (const Joint& each : joints) known.push_back(each.name);
  for (const NamedFrame& each : frames) known.push_back(each.name);
  known.insert(known.end(), more.begin(), more.end());
  problems.add(named.origin(),
               fmt::format("there is no {} or frame '{}'{}", is_urdf ? "link" : "joint", name,
                           config::did_you_mean(name, known)));
}

}  // namespace armature
