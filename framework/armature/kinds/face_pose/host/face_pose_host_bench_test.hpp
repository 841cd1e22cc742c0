// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <stdexcept>

#include "armature/kinds/face_pose/face_pose.hpp"
#include "armature/kinds/landmarks/landmark_messages.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/header.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"

// The host of the face pose estimators on a bench, with an estimator of the tests in its slot.
namespace armature::face_pose_host {

using Eigen::Vector3d;

/// A mouth where the first landmark is, on the camera's axis in the middle of the image.
class FirstLandmark final : public FacePoseEstimator {
 public:
  static inline FacePoseInput asked;
  static inline std::optional<RowDifference> rows;
  static inline bool throws = false;

  Expected<FacePose> estimate(const FacePoseInput& input, PluginState& state) override {
    asked = input;
    const Count* before = state.get<Count>();
    state.set(Count{before ? before->calls + 1 : 1});
    if (throws) throw std::runtime_error{"the matrix is singular"};
    const double u = input.landmarks.left.points[0].point.x();
    if (u < 0) return refuse(FaceRefusal::covered, "a hand is before the mouth");
    return FacePose{
        .left_eye = {1, 2, 3},
        .right_eye = {4, 5, 6},
        .mouth = {u, 0, 1},
        .normal = {0, 0, -1},
        .mouth_covariance = Vector3d{1, 2, 3}.asDiagonal(),
        .normal_covariance =
            (Eigen::Matrix3d{} << 1, 2, 3, 4, 5, 6, 7, 8, 9).finished() * state.get<Count>()->calls,
        .residual_px = 0.25,
        .rows = rows};
  }

 private:
  struct Count {
    static constexpr auto kLayout = layout_id("face_pose/first", 1);
    int calls;
  };
};

class NoLandmarks final : public LandmarkFinder {
 public:
  LandmarkScheme scheme() const override { return LandmarkScheme::five; }
  Expected<std::vector<Landmark>> find(const ImageView&, const PixelBox&) override {
    return refuse("none");
  }
};

inline PluginRegistry& plugins() {
  static PluginRegistry& registry = []() -> PluginRegistry& {
    PluginRegistry& built = built_plugins_with<FirstLandmark>(
        "{armature_plugin: 1, id: face_pose/first, kind: face_pose}");
    built.add<NoLandmarks>("{armature_plugin: 1, id: landmarks/none, kind: landmarks}");
    return built;
  }();
  return registry;
}

inline msg::Image image(double stamp_s) {
  msg::Image message;
  write_header(message.header_(), Time{} + seconds(stamp_s), "left_camera_optical");
  message.width_(4);
  message.height_(2);
  message.step_(4);
  message.encoding_("mono8");
  message.data_().assign(8, 7);
  return message;
}

inline msg::FaceLandmarks landmarks(double stamp_s, double u) {
  msg::FaceLandmarks message;
  message.header_() = image(stamp_s).header_();
  message.valid_(true);
  message.scheme_("ibug68");
  message.left_().assign(136, 0.5);
  message.left_()[0] = u;
  message.right_().assign(136, 0.25);
  message.left_sigma_().assign(68, 0.3);
  message.right_sigma_().assign(68, 0.4);
  message.left_box_(std::array<double, 4>{1, 2, 3, 4});
  message.score_(1.5);
  message.face_intensity_(80);
  return message;
}

/// f = 500 px, principal point (1.5, 0.5), baseline 120 mm.
inline msg::CameraInfo info() {
  msg::CameraInfo message;
  message.width_(4);
  message.height_(2);
  message.p_(std::array<double, 12>{500, 0, 1.5, -60, 0, 500, 0.5, 0, 0, 0, 1, 0});
  return message;
}

class FacePoseHostTest : public ::testing::Test {
 protected:
  explicit FacePoseHostTest(const char* component = "{plugin: face_pose/first}")
      : host_{plugins(), {.component = component, .robot = {}}} {}
  msg::FacePose see(const msg::Image& left, const msg::Image& right,
                    const msg::FaceLandmarks& found) {
    host_.send("left_image", left);
    host_.send("right_image", right);
    host_.send("landmarks", found);
    EXPECT_TRUE(host_.triggered());
    host_.step(to_seconds(stamp_of(left.header_().stamp_()) - Time{}));
    const auto answers = host_.take<msg::FacePose>("face");
    EXPECT_EQ(answers.size(), 1u);
    return answers.empty() ? msg::FacePose{} : answers.front();
  }
  msg::FacePose see(double stamp_s, double u) {
    return see(image(stamp_s), image(stamp_s), landmarks(stamp_s, u));
  }
  ComponentHarness host_;
};

}  // namespace armature::face_pose_host
