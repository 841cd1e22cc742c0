// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/files/urdf_chain.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <urdf_model/model.h>

#include <algorithm>
#include <cmath>

#include "armature/robot/files/joint_reader.hpp"
#include "armature/robot/files/robot_keys.hpp"
#include "armature/values/angles.hpp"

namespace armature {
namespace {

using config::Problems;
using Eigen::Isometry3d;
using Eigen::Vector3d;

Isometry3d transform_of(const urdf::Pose& pose) {
  const auto& r = pose.rotation;
  const auto& p = pose.position;
  Isometry3d result = Isometry3d::Identity();
  result.linear() = Eigen::Quaterniond{r.w, r.x, r.y, r.z}.normalized().toRotationMatrix();
  result.translation() = Vector3d{p.x, p.y, p.z};
  return result;
}

/// A frame with its z along `axis`; exact for the three axes of a frame and their opposites.
Isometry3d frame_along(const Vector3d& axis) {
  Eigen::Index least = 0;
  axis.cwiseAbs().minCoeff(&least);
  const Vector3d x = (Vector3d::Unit(least) - axis[least] * axis).normalized();
  Isometry3d result = Isometry3d::Identity();
  result.linear() << x, axis.cross(x), axis;
  return result;
}

std::string_view kind_of(const urdf::Joint& joint) {
  return joint.type == urdf::Joint::FLOATING ? "floating" : "planar";
}

/// The links of the file, those at the ends only or all.
std::vector<std::string> link_names(const urdf::ModelInterface& model, bool ends) {
  std::vector<std::string> names;
  for (const auto& [name, link] : model.links_) {
    if (!ends || link->child_joints.empty()) names.push_back(name);
  }
  return names;
}

/// One chain being read.
class ChainReader {
 public:
  ChainReader(const UrdfDocument& document, Problems& problems)
      : document_{document}, problems_{problems} {}

  UrdfChain read(const LinkName& base, const LinkName& tip) {
    const auto way = way_between(base, tip);
    if (!problems_.empty()) return {};
    for (const urdf::Joint* joint : way) add(*joint);
    if (chain_.joints.empty())
      problem(tip, fmt::format("no joint of {} moves between '{}' and '{}'", document_.file(),
                               chain_.links.front().name, tip.name));
    if (chain_.joints.size() > static_cast<std::size_t>(kMaxJoints))
      problem(tip,
              fmt::format("{} joints between '{}' and '{}' are too many; a robot may have {}",
                          chain_.joints.size(), chain_.links.front().name, tip.name, kMaxJoints));
    for (const urdf::Joint* joint : way) couple(*joint);
    return std::move(chain_);
  }

 private:
  void problem(const LinkName& at, std::string what) { problems_.add(at.origin, std::move(what)); }
  void problem(const urdf::Joint& at, const std::string& what) {
    problems_.add(document_.joint(at.name), fmt::format("joint '{}' {}", at.name, what));
  }

  const urdf::Link* link(const LinkName& wanted) {
    const auto found = document_.model().getLink(wanted.name);
    if (!found)
      problem(wanted,
              fmt::format("there is no link '{}' in {}{}", wanted.name, document_.file(),
                          config::did_you_mean(wanted.name, link_names(document_.model(), false))));
    return found.get();
  }

  /// The joints between two links in order; notes the base among the links.
  std::vector<const urdf::Joint*> way_between(const LinkName& base, const LinkName& tip) {
    if (tip.name.empty()) {
      problem(tip,
              fmt::format("the link that goals are stated for is missing; links at the ends "
                          "of {}: {}",
                          document_.file(), fmt::join(link_names(document_.model(), true), ", ")));
      return {};
    }
    const urdf::Link* from = base.name.empty() ? document_.model().getRoot().get() : link(base);
    const urdf::Link* at = link(tip);
    if (!from || !at) return {};
    std::vector<std::string> passed{at->name};
    std::vector<const urdf::Joint*> way;
    while (at != from && at->parent_joint) {
      way.push_back(at->parent_joint.get());
      at = at->getParent().get();
      passed.push_back(at->name);
    }
    if (at != from)
      problem(base, fmt::format("link '{}' does not carry '{}', which hangs on {}", from->name,
                                tip.name, fmt::join(passed, " < ")));
    std::ranges::reverse(way);
    chain_.links.push_back({.name = from->name});
    return way;
  }

  void check_origin(const urdf::Joint& joint) {
    const auto& [x, y, z] = joint.parent_to_joint_origin_transform.position;
    if (std::max({std::abs(x), std::abs(y), std::abs(z)}) <= kFarthest_m) return;
    problem(joint,
            fmt::format("has its origin at {:g}, {:g}, {:g}, farther than {:g} m; is it told "
                        "in another unit?",
                        x, y, z, kFarthest_m));
  }

  void add(const urdf::Joint& joint) {
    check_origin(joint);
    since_axis_ = since_axis_ * transform_of(joint.parent_to_joint_origin_transform);
    if (joint.type == urdf::Joint::FLOATING || joint.type == urdf::Joint::PLANAR)
      problem(joint, fmt::format("is {}, which is no joint of an arm; name a base behind it",
                                 kind_of(joint)));
    else if (joint.type != urdf::Joint::FIXED)
      add_moving(joint);
    chain_.links.push_back({joint.child_link_name, static_cast<int>(chain_.joints.size()) - 1,
                            since_axis_, joint.name});
  }

  void add_moving(const urdf::Joint& joint) {
    check_joint_name(joint.name, document_.joint(joint.name), problems_);
    Vector3d axis{joint.axis.x, joint.axis.y, joint.axis.z};
    const double length = axis.norm();
    if (!(length > 1e-9 && std::isfinite(length))) {
      problem(joint, "has an axis without a usable length");
      axis = Vector3d::UnitZ();
    }
    const Isometry3d joint_T_axis = frame_along(axis.normalized());
    chain_.before_T_axis.push_back(since_axis_ * joint_T_axis);
    since_axis_ = joint_T_axis.inverse();
    chain_.joints.push_back({.name = joint.name});
    chain_.places.push_back(document_.joint(joint.name));
    if (joint.type == urdf::Joint::PRISMATIC) chain_.joints.back().type = Joint::Type::prismatic;
    if (joint.limits) limit(joint, chain_.joints.back());
  }

  /// urdfdom sees to it that all but continuous joints have limits. Whether they are any is judged
  /// later: a robot file may state others.
  static void limit(const urdf::Joint& joint, Joint& limited) {
    const auto& [lower, upper, effort, velocity] = *joint.limits;
    if (joint.type != urdf::Joint::CONTINUOUS) {
      limited.lower = lower;
      limited.upper = upper;
    }
    if (velocity == 0) return;
    limited.max_velocity = velocity;
    limited.max_acceleration = usual_acceleration(velocity);
  }

  void check_mimic(const urdf::Joint& joint) {
    const double multiplier = joint.mimic->multiplier, offset = joint.mimic->offset;
    if (!(std::abs(multiplier) >= kMinRatio))
      problem(joint, fmt::format("mimics with a multiplier of {:g}, nearer to 0 than {:g}; a joint "
                                 "that does not move is fixed",
                                 multiplier, kMinRatio));
    if (std::abs(multiplier) > kMaxRatio)
      problem(joint, fmt::format("mimics with a multiplier of {:g}, more than {:g}; is it told in "
                                 "another unit?",
                                 multiplier, kMaxRatio));
    const bool slides = joint.type == urdf::Joint::PRISMATIC;
    if (!(std::abs(offset) <= (slides ? kFarthest_m : kWidest_deg * kRadPerDegree)))
      problem(joint,
              fmt::format("mimics with an offset of {:g} {}; is it told in another unit?", offset,
                          slides ? fmt::format("m, farther than {:g} m", kFarthest_m)
                                 : fmt::format("rad, more than {:g} degrees", kWidest_deg)));
  }

  void couple(const urdf::Joint& joint) {
    const auto name = [&](const Joint& one) { return one.name; };
    const auto follower = std::ranges::find(chain_.joints, joint.name, name);
    if (!joint.mimic || follower == chain_.joints.end()) return;
    const std::string& to = joint.mimic->joint_name;
    const auto leader = std::ranges::find(chain_.joints, to, name);
    if (leader == chain_.joints.end())
      return problem(joint, fmt::format("mimics '{}', which does not move between '{}' and '{}'; "
                                        "take a base and a tip with both between them",
                                        to, chain_.links.front().name, chain_.links.back().name));
    if (document_.model().getJoint(to)->mimic)
      return problem(joint, fmt::format("cannot mimic '{}', which mimics another joint itself; "
                                        "name the one that moves by itself",
                                        to));
    check_mimic(joint);
    follower->coupling = {.to = static_cast<int>(leader - chain_.joints.begin()),
                          .ratio = joint.mimic->multiplier,
                          .offset = joint.mimic->offset};
  }

  const UrdfDocument& document_;
  Problems& problems_;
  UrdfChain chain_;
  Isometry3d since_axis_ = Isometry3d::Identity();  // the last link seen from the last axis
};

}  // namespace

UrdfChain read_urdf_chain(const UrdfDocument& document, const LinkName& base, const LinkName& tip,
                          Problems& problems) {
  return ChainReader{document, problems}.read(base, tip);
}

}  // namespace armature
