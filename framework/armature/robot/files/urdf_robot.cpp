// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/files/urdf_robot.hpp"

#include <fmt/format.h>
#include <urdf_model/model.h>

#include <algorithm>
#include <cmath>

#include "armature/robot/files/robot_keys.hpp"
#include "armature/robot/files/urdf_chain.hpp"
#include "armature/robot/model/denavit_hartenberg.hpp"
#include "armature/values/angles.hpp"

namespace armature {
namespace {

std::map<std::string, std::string> no_frames_of(const UrdfDocument& document,
                                                const UrdfChain& chain) {
  std::map<std::string, std::string> no_frames;
  if (chain.links.empty()) return no_frames;
  const std::string& base = chain.links.front().name;
  for (const auto& link : chain.links) {
    if (link.urdf_joint.empty()) continue;  // the first
    no_frames.emplace(link.urdf_joint,
                      fmt::format("a joint of {}; name the link that it carries: '{}'",
                                  document.file(), link.name));
  }
  for (const auto& [name, link] : document.model().links_) {
    no_frames.emplace(name, fmt::format("a link of {} that does not lie between '{}', on which "
                                        "the arm stands, and '{}'; name one that does",
                                        document.file(), base, chain.links.back().name));
  }
  for (const auto& link : chain.links) no_frames.erase(link.name);
  return no_frames;
}

/// 'base' is the robot's foot in every robot file and on every topic.
void check_base(const UrdfChain& chain, const UrdfDocument& document, const LinkName& base,
                config::Problems& problems) {
  for (std::size_t i = 1; i < chain.links.size(); ++i) {
    if (chain.links[i].name != "base") continue;
    problems.add(base.origin,
                 fmt::format("'base' would be two things: what the arm stands on, which is '{}', "
                             "and a link of {} that hangs on it; stand the arm on that link (base: "
                             "base, or --base base), or give it another name",
                             chain.links.front().name, document.file()));
  }
}

/// Notes every joint that follows one whose limits, together with those of its followers, leave it
/// no room.
void check_followers(const RobotModel& model, const std::vector<config::Origin>& places,
                     config::Problems& problems) {
  for (std::size_t i = 0; i < model.joints().size(); ++i) {
    const Joint& follower = model.joints()[i];
    const int leader = model.chain()[i].independent;
    if (!follower.coupling || model.lower()[leader] < model.upper()[leader]) continue;
    const auto& moved = model.joints()[static_cast<std::size_t>(model.independent_joint(leader))];
    problems.add(places[i], fmt::format("joint '{}' mimics '{}', which has no room to move: its "
                                        "limits and those of the joints that follow it exclude "
                                        "each other; correct the limits, the multiplier or the "
                                        "offset",
                                        follower.name, moved.name));
  }
}

}  // namespace

UrdfArm read_urdf_arm(const std::filesystem::path& file, const config::Origin& named_at,
                      const LinkName& base, const LinkName& tip, config::Problems& problems) {
  UrdfArm arm;
  UrdfChain chain;
  bool has_tool_link = false;
  try {
    const UrdfDocument document = UrdfDocument::load(file, named_at);
    arm.name = document.model().getName();
    chain = read_urdf_chain(document, base, tip, problems);
    check_base(chain, document, base, problems);
    arm.no_frames = no_frames_of(document, chain);
    has_tool_link = document.model().getLink("tool") != nullptr;
  } catch (const config::ConfigError& error) {
    for (const config::Problem& problem : error.problems())
      problems.add(problem.origin, problem.message);
  }
  const auto row_T_axis = to_denavit_hartenberg(chain.before_T_axis, chain.joints);
  arm.joints = std::move(chain.joints);
  arm.places = std::move(chain.places);
  for (const auto& [name, joint, axis_T_link, urdf_joint] : chain.links) {
    if (name == tip.name) arm.tip = FrameId{static_cast<int>(arm.frames.size())};
    const Eigen::Isometry3d parent_T_link =
        joint < 0 ? axis_T_link : row_T_axis[static_cast<std::size_t>(joint)] * axis_T_link;
    const bool is_base = &name == &chain.links.front().name && name == "base";
    if (!is_base) arm.frames.push_back({name, joint, parent_T_link});  // that frame is there anyway
    if (name == tip.name && !has_tool_link) arm.tool = NamedFrame{"tool", joint, parent_T_link};
  }
  return arm;
}

void check_urdf_limits(const UrdfArm& arm, const std::vector<Joint>& joints,
                       config::Problems& problems) {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const Joint &own = arm.joints[i], &joint = joints[i];
    if (joint.locked) continue;
    const bool slides = own.type == Joint::Type::prismatic;
    const auto note = [&](const std::string& what, const std::string& instead) {
      problems.add(arm.places[i],
                   fmt::format("joint '{0}' {1}; correct it there, or in a robot file: joints: "
                               "[{{name: {0}, {2}}}]",
                               own.name, what, instead));
    };
    const bool same_range = joint.lower == own.lower && joint.upper == own.upper;
    if (same_range && !(own.lower < own.upper)) {
      note(fmt::format("has no room to move: its limits are {:g} to {:g}", own.lower, own.upper),
           slides ? "limits_m: [0, 1]" : "limits_deg: [-90, 90]");
    }
    const double farthest = slides ? kFarthest_m : kWidest_deg * kRadPerDegree;
    const bool is_far = std::max(std::abs(own.lower), std::abs(own.upper)) > farthest;
    if (same_range && is_far && own.lower < own.upper && std::isfinite(own.upper)) {
      const std::string bound = slides ? fmt::format("m, farther than {:g} m", kFarthest_m)
                                       : fmt::format("rad, more than {:g} degrees", kWidest_deg);
      note(fmt::format("has limits of {:g} to {:g} {}", own.lower, own.upper, bound),
           slides ? "limits_m: [0, 1]" : "limits_deg: [-90, 90]");
    }
    if (joint.max_velocity == own.max_velocity && own.max_velocity < kMinRate) {
      note(fmt::format("has a velocity limit of {:g}, which is below {:g}", own.max_velocity,
                       kMinRate),
           slides ? "velocity_m_s: 1" : "velocity_rad_s: 1");
    }
  }
}

RobotModel load_urdf_robot(const std::filesystem::path& file, const LinkName& base,
                           const LinkName& tip) {
  config::Problems problems;
  UrdfArm arm = read_urdf_arm(file, {}, base, tip, problems);
  check_urdf_limits(arm, arm.joints, problems);
  problems.throw_if_any();
  RobotModel model{{std::move(arm.name), RobotModel::Convention::modified, std::move(arm.joints),
                    std::move(arm.frames), arm.tip, std::nullopt, std::nullopt}};
  check_followers(model, arm.places, problems);
  problems.throw_if_any();
  return model;
}

}  // namespace armature
