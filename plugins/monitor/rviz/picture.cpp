// SPDX-License-Identifier: Apache-2.0
#include "picture.hpp"

#include <algorithm>
#include <array>

#include "armature/messages/geometry.hpp"
#include "armature/messages/header.hpp"
#include "robot_shape.hpp"

namespace armature::monitor::rviz {
namespace {

using Eigen::Vector3d;

constexpr double kNormalLength = 0.1;    // [m] of a target's arrow
constexpr double kPointDiameter = 0.02;  // [m] of a target's and a face's points
constexpr double kShaftDiameter = 0.008, kPathWidth = 0.004;  // [m]
constexpr Duration kOldestFace = seconds(1);

constexpr Color kLink{0.75F, 0.77F, 0.80F, 1}, kJoint{0.25F, 0.35F, 0.50F, 1};
constexpr Color kPointing{1.0F, 0.75F, 0.10F, 1}, kCone{1.0F, 0.95F, 0.6F, 0.25F};
constexpr Color kTarget{0.10F, 0.70F, 0.20F, 1}, kTruth{0.85F, 0.15F, 0.15F, 0.6F};
constexpr Color kFace{0.10F, 0.65F, 0.85F, 1}, kPath{0.95F, 0.45F, 0.10F, 1};

bool finite(const msg::Point& p) { return to_eigen(p).allFinite(); }

}  // namespace

void GoalWatch::see(const msg::MotionStatus& status) {
  constexpr std::uint8_t kExecuting = 1;  // 0 accepted; above: over
  if (newest_ && status.goal_id_() < *newest_) return;
  newest_ = status.goal_id_();
  active_ = status.state_() <= kExecuting;
}

bool GoalWatch::pursues(std::uint64_t goal_id) const {
  if (!newest_ || *newest_ < goal_id) return true;
  return *newest_ == goal_id && active_;
}

Picture::Picture(const RobotModel& model, const FrameTree& tree, const Parameters& parameters)
    : model_{&model}, tree_{&tree}, parameters_{parameters}, radius_{link_radius(model)} {}

msg::MarkerArray Picture::draw(const JointVector& q, Time stamp, const Surroundings& around) const {
  msg::MarkerArray array;
  add_links(q, stamp, array);
  add_pointing(stamp, array);
  add_target("target", around.target, stamp, kTarget, array);
  add_target("truth", around.truth, stamp, kTruth, array);
  add_face(around.face, stamp, array);
  add_path(around, stamp, array);
  return array;
}

void Picture::add_links(const JointVector& q, Time stamp, msg::MarkerArray& array) const {
  for (const RobotPart& part : robot_shape(*model_, q)) {
    MarkerHead head{.ns = "links",
                    .id = part.id,
                    .frame = tree_->joint_frame(part.frame),
                    .stamp = stamp,
                    .rides = true,
                    .color = kLink};
    if (part.kind == RobotPart::Kind::link) {
      array.markers_().push_back(cylinder(head, part.segment, radius_));
      continue;
    }
    head.color = kJoint;
    const Segment body = joint_body(part, radius_);
    array.markers_().push_back(part.kind == RobotPart::Kind::revolute_joint
                                   ? cylinder(head, body, 1.5 * radius_)
                                   : bar(head, body, 3 * radius_));
  }
}

void Picture::add_pointing(Time stamp, msg::MarkerArray& array) const {
  if (!model_->pointing_axis() || parameters_.axis_length == 0) return;
  MarkerHead head{.ns = "pointing",
                  .frame = tree_->name(model_->frame(model_->tool()).name),
                  .stamp = stamp,
                  .rides = true,
                  .color = kPointing};
  const Segment axis{Vector3d::Zero(), parameters_.axis_length * *model_->pointing_axis()};
  array.markers_().push_back(arrow(head, axis, kShaftDiameter));
  if (parameters_.cone_half_angle == 0) return;
  head.id = 1;
  head.color = kCone;
  array.markers_().push_back(cone(head, axis, parameters_.cone_half_angle));
}

/// At the time of the joint sample: an old estimate still stands where it was measured.
void Picture::add_target(const char* ns, const msg::Target* target, Time stamp, Color color,
                         msg::MarkerArray& array) const {
  if (!target) return;
  MarkerHead head{.ns = ns, .frame = frame_of(target->header_()), .stamp = stamp, .color = color};
  const Vector3d at = to_eigen(target->position_()), normal = to_eigen(target->normal_());
  const bool shown = target->valid_() && at.allFinite();
  array.markers_().push_back(shown ? sphere(head, at, kPointDiameter) : removal(head));
  head.id = 1;
  array.markers_().push_back(
      shown && normal.allFinite() && normal.norm() > 0
          ? arrow(head, {at, at + kNormalLength * normal.normalized()}, kShaftDiameter)
          : removal(head));
}

/// In the camera's frame, so at the time of the picture, and not for longer than tf remembers.
void Picture::add_face(const msg::FacePose* face, Time now, msg::MarkerArray& array) const {
  if (!face) return;
  const MarkerHead head{.ns = "face",
                        .frame = frame_of(face->header_()),
                        .stamp = stamp_of(face->header_().stamp_()),
                        .color = kFace};
  const bool shown = face->valid_() && now - head.stamp < kOldestFace &&
                     finite(face->left_eye_()) && finite(face->right_eye_()) &&
                     finite(face->mouth_());
  const std::array<Vector3d, 3> points{to_eigen(face->left_eye_()), to_eigen(face->right_eye_()),
                                       to_eigen(face->mouth_())};
  array.markers_().push_back(shown ? spheres(head, points, kPointDiameter / 2) : removal(head));
}

void Picture::add_path(const Surroundings& around, Time stamp, msg::MarkerArray& array) const {
  if (!around.path) return;
  const MarkerHead head{
      .ns = "path", .frame = frame_of(around.path->header_()), .stamp = stamp, .color = kPath};
  const auto& points = around.path->position_();
  const bool shown = around.path_is_followed && points.size() >= 2 &&
                     std::all_of(points.begin(), points.end(), finite);
  array.markers_().push_back(shown ? line_strip(head, points, kPathWidth) : removal(head));
}

/// The frame of this arm that a topic names; a header without a name means the base.
std::string Picture::frame_of(const msg::Header& header) const {
  return tree_->name(header.frame_id_().empty() ? kBaseFrame
                                                : std::string_view{header.frame_id_()});
}

}  // namespace armature::monitor::rviz
