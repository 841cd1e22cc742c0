// SPDX-License-Identifier: Apache-2.0
#include "urdf_text.hpp"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "armature/robot/geometry/rotation.hpp"
#include "robot_shape.hpp"

namespace armature::monitor::rviz {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kNoLimit = 1e9;  // [rad], [m] or one of them in a second

std::string number(double value) { return fmt::format("{:.17g}", value == 0 ? 0.0 : value); }

std::string numbers(const Vector3d& v) {
  return number(v.x()) + " " + number(v.y()) + " " + number(v.z());
}

/// Writes the elements of a URDF file, one after the other.
class Writer {
 public:
  void open(const char* element) { printer_.OpenElement(element); }
  void close() { printer_.CloseElement(); }
  void say(const char* attribute, const std::string& value) {
    printer_.PushAttribute(attribute, value.c_str());
  }
  void element(const char* name, const char* attribute, const std::string& value) {
    open(name);
    say(attribute, value);
    close();
  }
  void origin(const Isometry3d& pose) {
    open("origin");
    say("xyz", numbers(pose.translation()));
    say("rpy", numbers(rpy_from_rotation(pose.linear())));
    close();
  }
  /// A joint with its links; more may be said of it until it is closed.
  void open_joint(const std::string& name, const char* type, const std::string& parent,
                  const std::string& child, const Isometry3d& parent_T_child) {
    open("joint");
    say("name", name);
    say("type", type);
    element("parent", "link", parent);
    element("child", "link", child);
    origin(parent_T_child);
  }
  std::string text() const { return std::string{"<?xml version=\"1.0\"?>\n"} + printer_.CStr(); }

 private:
  tinyxml2::XMLPrinter printer_;
};

Isometry3d along_axis(const Vector3d& axis, double value, bool slide) {
  Isometry3d moved = Isometry3d::Identity();
  if (slide) {
    moved.translation() = value * axis;
  } else {
    moved.linear() = Eigen::AngleAxisd{value, axis}.toRotationMatrix();
  }
  return moved;
}

void write_visual(const Segment& segment, const char* shape, double radius, Writer& writer) {
  const Vector3d along = segment.to - segment.from;
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = 0.5 * (segment.from + segment.to);
  pose.linear() = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), along).toRotationMatrix();
  writer.open("visual");
  writer.origin(pose);
  writer.open("geometry");
  writer.open(shape);
  if (std::string_view{shape} == "box") {
    writer.say("size", numbers({2 * radius, 2 * radius, along.norm()}));
  } else {
    writer.say("radius", number(radius));
    writer.say("length", number(along.norm()));
  }
  writer.close();
  writer.close();
  writer.close();
}

/// The looks of a joint's frame, of -1 those of the base.
void write_link(const std::string& name, int frame, const std::vector<RobotPart>& parts,
                double radius, Writer& writer) {
  writer.open("link");
  writer.say("name", name);
  for (const RobotPart& part : parts) {
    if (part.frame != frame) continue;
    if (part.kind == RobotPart::Kind::link) {
      if (part.segment.from != part.segment.to) {
        write_visual(part.segment, "cylinder", radius, writer);
      }
      continue;
    }
    const bool slides = part.kind == RobotPart::Kind::prismatic_joint;
    write_visual(joint_body(part, radius), slides ? "box" : "cylinder", 1.5 * radius, writer);
  }
  writer.close();
}

void write_limit(const Joint& joint, Writer& writer) {
  const auto bounded = [](double limit) { return number(std::clamp(limit, -kNoLimit, kNoLimit)); };
  writer.open("limit");
  writer.say("effort", "0");
  writer.say("velocity", bounded(joint.max_velocity));
  if (std::isfinite(joint.lower) || std::isfinite(joint.upper) ||
      joint.type == Joint::Type::prismatic) {
    writer.say("lower", bounded(joint.lower));
    writer.say("upper", bounded(joint.upper));
  }
  writer.close();
}

void write_joint(const RobotModel& model, const FrameTree& tree, int i, Writer& writer) {
  const Joint& joint = model.joints()[static_cast<std::size_t>(i)];
  const JointPlace place = joint_place(model, i);
  const std::string parent = tree.joint_frame(i - 1), child = tree.joint_frame(i);
  const std::string moved = place.moved_T_joint ? tree.moved_frame(i) : child;
  if (joint.locked) {
    const double value = (*model.home())[i];
    const Isometry3d pose =
        place.before_T_moved * along_axis(place.axis, value, joint.type == Joint::Type::prismatic);
    writer.open_joint(joint.name, "fixed", parent, moved, pose);
    writer.close();
  } else {
    const bool slides = joint.type == Joint::Type::prismatic;
    const bool ends = std::isfinite(joint.lower) || std::isfinite(joint.upper);
    writer.open_joint(joint.name,
                      slides ? "prismatic"
                      : ends ? "revolute"
                             : "continuous",
                      parent, moved, place.before_T_moved);
    writer.element("axis", "xyz", numbers(place.axis));
    write_limit(joint, writer);
    if (joint.coupling) {
      writer.open("mimic");
      writer.say("joint", model.joints()[static_cast<std::size_t>(joint.coupling->to)].name);
      writer.say("multiplier", number(joint.coupling->ratio));
      writer.say("offset", number(joint.coupling->offset));
      writer.close();
    }
    writer.close();
  }
  if (!place.moved_T_joint) return;
  writer.open_joint(child + "_fixed", "fixed", moved, child, *place.moved_T_joint);
  writer.close();
}

}  // namespace

std::string urdf_text(const RobotModel& model, const FrameTree& tree) {
  Writer writer;
  const JointVector home =
      model.home() ? *model.to_independent(*model.home()) : JointVector::Zero(model.dof());
  const std::vector<RobotPart> parts = robot_shape(model, home);
  const double radius = link_radius(model);
  writer.open("robot");
  writer.say("name", model.name());
  for (int i = -1; i < model.joint_count(); ++i) {
    write_link(tree.joint_frame(i), i, parts, radius, writer);
    if (i >= 0 && joint_place(model, i).moved_T_joint) {
      write_link(tree.moved_frame(i), model.joint_count(), parts, radius, writer);
    }
  }
  for (int i = 0; i < model.joint_count(); ++i) write_joint(model, tree, i, writer);
  for (const FrameTree::Edge& edge : tree.fixed()) {
    // The world, where there is one, stands above the base.
    const bool is_base = edge.child == tree.joint_frame(-1);
    write_link(is_base ? edge.parent : edge.child, model.joint_count(), parts, radius, writer);
    writer.open_joint(edge.child + "_fixed", "fixed", edge.parent, edge.child, edge.parent_T_child);
    writer.close();
  }
  writer.close();
  return writer.text();
}

}  // namespace armature::monitor::rviz
