// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "armature/robot/model/joint_vector.hpp"
#include "armature/values/expected.hpp"
#include "armature/values/inline_text.hpp"

namespace armature {
namespace config ARMATURE_EXPORT {
class Node;
}  // namespace config
}  // namespace armature

namespace armature ARMATURE_EXPORT {

/// One Denavit-Hartenberg row and what the joint can do.
///   standard: T_i = Rz(theta) Tz(d) Tx(a) Rx(alpha)
///   modified: T_i = Rx(alpha) Tx(a) Rz(theta) Tz(d)     (Craig)
/// The joint's value is added to `theta` (revolute) or to `d` (prismatic). In front of the row
/// stands the frame of the joint before, or the base; with a `placement` what that maps to.
struct Joint {
  enum class Type { revolute, prismatic };
  /// q of this joint = ratio * q[to] + offset; `to` indexes an independent joint of the chain.
  struct Coupling {
    int to = 0;
    double ratio = 1;
    double offset = 0;
    // [rad] or [m] that a sensor of its own may say otherwise; none: 1e-6, and 1e-6 in its rates.
    std::optional<double> within;
  };

  std::string name;
  Type type = Type::revolute;
  double theta = 0;  // [rad] offset of a revolute joint, or the fixed angle of a prismatic one
  double d = 0;      // [m]
  double a = 0;      // [m]
  double alpha = 0;  // [rad]
  // Without limits of its own until it is given some (a coupled joint may leave them to its
  // leader).
  double lower = -std::numeric_limits<double>::infinity();            // [rad] or [m]
  double upper = std::numeric_limits<double>::infinity();             // [rad] or [m]
  double max_velocity = std::numeric_limits<double>::infinity();      // [rad/s] or [m/s]
  double max_acceleration = std::numeric_limits<double>::infinity();  // [rad/s2] or [m/s2]
  std::optional<Coupling> coupling;                                   // none: an independent joint
  bool locked = false;  // stands where it is at home, and is no independent joint
  double drive_inertia =
      0;  // [kg m2] of a revolute joint's drive, at the joint; else its mass [kg]
  /// Constant, in front of the row: how it hangs on the frame before where no row can say it well
  /// (a base turned in space, axes nearly parallel). None: identity.
  std::optional<Eigen::Isometry3d> placement;
};

/// A frame fixed to a link (a joint's frame), to the base or to another named frame.
struct NamedFrame {
  std::string name;
  int parent_joint = -1;  // index into joints(), -1: the base
  Eigen::Isometry3d parent_T_frame = Eigen::Isometry3d::Identity();
};

/// The straight shaft of an instrument that an arm moves through an incision: a line through the
/// tool's origin, the instrument's tip.
struct Shaft {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  // in the tool frame, towards the tip
  double length = 0;                                // [m] of the straight part behind the tip
};

/// The body of a link, or a part of it: everything within `radius` of the straight line between two
/// points of a joint's frame; a ball where they are one point.
struct LinkCapsule {
  std::string name;
  int parent_joint = -1;     // index into joints(), -1: the base
  Eigen::Vector3d from, to;  // [m] in that joint's frame
  double radius = 0;         // [m]
};

/// A part of a link's mass, as if it were in one point.
struct LinkMass {
  std::string name;
  int parent_joint = -1;                             // index into joints(), -1: the base
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // [m] in that joint's frame
  double mass = 0;                                   // [kg]
};

/// A joint as kinematics needs it, everything that does not change worked out: the joint's value is
/// ratio * q[independent] + offset. Of a locked joint the ratio is 0.
struct ChainLink {
  int independent = 0;  // index into the independent joints
  double ratio = 1, offset = 0;
  bool prismatic = false;
  double theta = 0, d = 0, a = 0;  // [rad], [m], [m]
  double cos_alpha = 1, sin_alpha = 0;
  Eigen::Isometry3d placement = Eigen::Isometry3d::Identity();
};

/// Index of a named frame of a robot model.
enum class FrameId : int {};

/// What a robot model is made of.
struct RobotParts {
  enum class Convention { standard, modified };

  std::string name;
  Convention convention = Convention::standard;
  std::vector<Joint> joints;
  std::vector<NamedFrame> frames;
  FrameId tool{};                                               // the tip that goals are stated for
  std::optional<Eigen::Vector3d> pointing_axis = std::nullopt;  // in the tool frame
  std::optional<JointVector> home = std::nullopt;               // of all joints
  std::optional<Shaft> shaft = std::nullopt;
  std::vector<LinkCapsule> capsules = {};
  std::vector<LinkMass> masses = {};
};

/// A serial arm as data: joints, couplings, limits, named frames, pointing axis and home.
/// Immutable after it was read; shared by every solver that was made for it.
/// "independent" vectors have dof() entries, "all" vectors joint_count().
class RobotModel {
 public:
  using Convention = RobotParts::Convention;

  /// Throws std::invalid_argument when the parts do not fit together (a coupling to a joint that is
  /// coupled itself, locked or not there, a frame on such a joint, no joints or more than
  /// kMaxJoints, none that is independent, a home of another length, a locked joint and no home);
  /// files are checked by read_robot_model, which says more.
  RobotModel(RobotParts parts);

  /// To make another one that differs in some.
  const RobotParts& parts() const { return parts_; }
  const std::string& name() const { return parts_.name; }
  Convention convention() const { return parts_.convention; }
  const std::vector<Joint>& joints() const { return parts_.joints; }
  const std::vector<NamedFrame>& frames() const { return parts_.frames; }
  int joint_count() const { return static_cast<int>(parts_.joints.size()); }
  int dof() const { return static_cast<int>(independent_.size()); }
  /// Index into joints() of the i-th independent joint.
  int independent_joint(int i) const { return independent_[static_cast<std::size_t>(i)]; }

  /// The frame named `tool`: the tip that goals are stated for.
  FrameId tool() const { return parts_.tool; }
  std::optional<FrameId> find_frame(std::string_view name) const;
  const NamedFrame& frame(FrameId id) const { return parts_.frames[static_cast<std::size_t>(id)]; }

  /// The unit axis of the tool frame that a pointing goal aligns with a direction.
  const std::optional<Eigen::Vector3d>& pointing_axis() const { return parts_.pointing_axis; }
  /// The instrument's shaft, if the file names one; its axis has length 1.
  const std::optional<Shaft>& shaft() const { return parts_.shaft; }
  /// The bodies of the links, as far as the file states them.
  const std::vector<LinkCapsule>& capsules() const { return parts_.capsules; }
  /// The masses of the links, as far as the file states them.
  const std::vector<LinkMass>& masses() const { return parts_.masses; }
  /// Home position of all joints, if the file names one.
  const std::optional<JointVector>& home() const { return parts_.home; }

  /// Independent values -> all joints, couplings applied.
  JointVector to_all(const JointVector& independent) const;
  /// All joints -> independent values; a reason when the length is wrong, a value is not finite, a
  /// coupled joint contradicts its coupling by more than 1e-6 (or than its `within`), or a locked
  /// joint has left its place by more than 1e-4 (metres or radians).
  Expected<JointVector> to_independent(const JointVector& all) const;
  /// The same from a list that may have any length, as it comes from outside.
  Expected<JointVector> to_independent(std::span<const double> all) const;
  /// The same of velocities or accelerations: a coupling's offset does not count, and a locked
  /// joint not at all, nor a coupled one that has a `within`: two sensors never agree in rates.
  Expected<JointVector> contract_rates(std::span<const double> all) const;
  /// The same into `independent`: empty, or the reason. Real-time safe.
  ReasonText to_independent(std::span<const double> all, JointVector& independent) const;
  ReasonText contract_rates(std::span<const double> all, JointVector& independent) const;

  /// One entry per joint, in order: what the kinematics functions walk along.
  const std::vector<ChainLink>& chain() const { return chain_; }
  /// Whether some joint has a placement.
  bool is_placed() const { return is_placed_; }

  /// Limits of the independent joints; those of coupled joints are folded in.
  const JointVector& lower() const { return lower_; }
  const JointVector& upper() const { return upper_; }
  const JointVector& max_velocity() const { return max_velocity_; }
  const JointVector& max_acceleration() const { return max_acceleration_; }
  bool within_limits(const JointVector& independent, double tolerance = 1e-9) const;
  /// Revolute independent joints, for wrap-aware distances.
  bool is_revolute(int i) const;

 private:
  void number_joints();
  void fold_limits();
  ReasonText contracted(std::span<const double> all, double offset_factor,
                        JointVector& independent) const;

  RobotParts parts_;
  std::vector<int> independent_;
  std::vector<ChainLink> chain_;
  bool is_placed_ = false;
  JointVector lower_, upper_, max_velocity_, max_acceleration_;
};

/// Home, or for a robot without one the middle of the limits (0 without limits): independent
/// joints.
JointVector resting_position(const RobotModel& model);

/// Reads an `armature_robot: 1` document. Throws config::ConfigError with everything that is wrong.
RobotModel read_robot_model(const config::Node& document);
/// The same from a file.
RobotModel load_robot_model(const std::filesystem::path& file);

}  // namespace armature
