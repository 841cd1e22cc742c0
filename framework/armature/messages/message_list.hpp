// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/messages/message_type.hpp"

// The one table of message types: X(package, name in CamelCase). Names, headers, registry, encoding
// and tests derive from it; a type of idl/ that is missing here fails a test.

#define ARMATURE_MESSAGES_BUILTIN_INTERFACES(X) \
  X(builtin_interfaces, Time)                   \
  X(builtin_interfaces, Duration)

#define ARMATURE_MESSAGES_STD_MSGS(X) \
  X(std_msgs, Header)                 \
  X(std_msgs, String)                 \
  X(std_msgs, Bool)                   \
  X(std_msgs, Float64)                \
  X(std_msgs, ColorRGBA)

#define ARMATURE_MESSAGES_GEOMETRY_MSGS(X) \
  X(geometry_msgs, Point)                  \
  X(geometry_msgs, Vector3)                \
  X(geometry_msgs, Quaternion)             \
  X(geometry_msgs, Pose)                   \
  X(geometry_msgs, PoseStamped)            \
  X(geometry_msgs, Transform)              \
  X(geometry_msgs, TransformStamped)

#define ARMATURE_MESSAGES_TF2_MSGS(X) X(tf2_msgs, TFMessage)

#define ARMATURE_MESSAGES_SENSOR_MSGS(X) \
  X(sensor_msgs, Image)                  \
  X(sensor_msgs, CompressedImage)        \
  X(sensor_msgs, RegionOfInterest)       \
  X(sensor_msgs, CameraInfo)             \
  X(sensor_msgs, JointState)

#define ARMATURE_MESSAGES_TRAJECTORY_MSGS(X) \
  X(trajectory_msgs, JointTrajectoryPoint)   \
  X(trajectory_msgs, JointTrajectory)

#define ARMATURE_MESSAGES_DIAGNOSTIC_MSGS(X) \
  X(diagnostic_msgs, KeyValue)               \
  X(diagnostic_msgs, DiagnosticStatus)       \
  X(diagnostic_msgs, DiagnosticArray)

#define ARMATURE_MESSAGES_ROSGRAPH_MSGS(X) X(rosgraph_msgs, Clock)

#define ARMATURE_MESSAGES_VISUALIZATION_MSGS(X) \
  X(visualization_msgs, UVCoordinate)           \
  X(visualization_msgs, MeshFile)               \
  X(visualization_msgs, Marker)                 \
  X(visualization_msgs, MarkerArray)

#define ARMATURE_MESSAGES_ARMATURE_MSGS(X) \
  X(armature_msgs, FaceLandmarks)          \
  X(armature_msgs, FacePose)               \
  X(armature_msgs, Target)                 \
  X(armature_msgs, ForbiddenZone)          \
  X(armature_msgs, MotionGoal)             \
  X(armature_msgs, MotionStatus)           \
  X(armature_msgs, ToolPath)               \
  X(armature_msgs, JointReference)         \
  X(armature_msgs, QuinticTrajectory)      \
  X(armature_msgs, MotionPlanRequest)      \
  X(armature_msgs, MotionPlan)             \
  X(armature_msgs, IkRequest)              \
  X(armature_msgs, IkSolution)             \
  X(armature_msgs, IkResponse)             \
  X(armature_msgs, ToolPose)               \
  X(armature_msgs, PathRequest)            \
  X(armature_msgs, PathSample)             \
  X(armature_msgs, PathSegment)            \
  X(armature_msgs, PathResponse)           \
  X(armature_msgs, JointPosition)          \
  X(armature_msgs, IkBranches)             \
  X(armature_msgs, SelectRequest)          \
  X(armature_msgs, SelectResponse)         \
  X(armature_msgs, JointSegment)           \
  X(armature_msgs, TrajectoryRequest)      \
  X(armature_msgs, TrajectoryResponse)     \
  X(armature_msgs, RegistrationRequest)    \
  X(armature_msgs, RegisteredTarget)       \
  X(armature_msgs, RegistrationResponse)   \
  X(armature_msgs, NeedlePlan)             \
  X(armature_msgs, MeasuredMarkers)        \
  X(armature_msgs, TrackedBody)            \
  X(armature_msgs, ImplantPlan)            \
  X(armature_msgs, LightLevel)             \
  X(armature_msgs, Capture)                \
  X(armature_msgs, TaskState)              \
  X(armature_msgs, StepTiming)             \
  X(armature_msgs, ComponentState)

#define ARMATURE_MESSAGES(X)              \
  ARMATURE_MESSAGES_BUILTIN_INTERFACES(X) \
  ARMATURE_MESSAGES_STD_MSGS(X)           \
  ARMATURE_MESSAGES_GEOMETRY_MSGS(X)      \
  ARMATURE_MESSAGES_TF2_MSGS(X)           \
  ARMATURE_MESSAGES_SENSOR_MSGS(X)        \
  ARMATURE_MESSAGES_TRAJECTORY_MSGS(X)    \
  ARMATURE_MESSAGES_DIAGNOSTIC_MSGS(X)    \
  ARMATURE_MESSAGES_ROSGRAPH_MSGS(X)      \
  ARMATURE_MESSAGES_VISUALIZATION_MSGS(X) \
  ARMATURE_MESSAGES_ARMATURE_MSGS(X)

/// armature::msg::JointState, and that the bus knows it.
#define ARMATURE_DECLARE_MESSAGE(package, Name) \
  namespace armature::msg {                     \
  using Name = ::package::msg::dds_::Name##_;   \
  }                                             \
  namespace armature {                          \
  template <>                                   \
  const MessageType& message_type<msg::Name>(); \
  }
