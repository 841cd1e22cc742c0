// SPDX-License-Identifier: Apache-2.0
// The host of the face pose estimators: 1. one answer for each pair of pictures with its landmarks,
// under their header, 2. the camera is that of the right camera's info, 3. what cannot be estimated
// is answered with its exact reason, 4. frozen cameras are refused, and a still scene without noise
// is none, 5. rows that differ on average are told before any pair is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <random>
#include <stdexcept>
#include <string>

#include "armature/kinds/face_pose/face_pose.hpp"
#include "armature/kinds/landmarks/landmark_messages.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/header.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"

namespace armature::face_pose_host {
namespace {

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

PluginRegistry& plugins() {
  static PluginRegistry& registry = []() -> PluginRegistry& {
    PluginRegistry& built = built_plugins_with<FirstLandmark>(
        "{armature_plugin: 1, id: face_pose/first, kind: face_pose}");
    built.add<NoLandmarks>("{armature_plugin: 1, id: landmarks/none, kind: landmarks}");
    return built;
  }();
  return registry;
}

msg::Image image(double stamp_s) {
  msg::Image message;
  write_header(message.header_(), Time{} + seconds(stamp_s), "left_camera_optical");
  message.width_(4);
  message.height_(2);
  message.step_(4);
  message.encoding_("mono8");
  message.data_().assign(8, 7);
  return message;
}

msg::FaceLandmarks landmarks(double stamp_s, double u) {
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
msg::CameraInfo info() {
  msg::CameraInfo message;
  message.width_(4);
  message.height_(2);
  message.p_(std::array<double, 12>{500, 0, 1.5, -60, 0, 500, 0.5, 0, 0, 0, 1, 0});
  return message;
}

class FacePoseHostTest : public ::testing::Test {
 protected:
  explicit FacePoseHostTest(const char* component = "{plugin: face_pose/first}")
      : host_{plugins(), {.component = component, .robot = {}, .rig = {}}} {}
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

class FacePoseHostWithFinder : public FacePoseHostTest {
 protected:
  FacePoseHostWithFinder()
      : FacePoseHostTest{"{plugin: face_pose/first, landmarks: {plugin: landmarks/none}}"} {}
};

TEST_F(FacePoseHostWithFinder, LendsTheEstimatorTheFinderThatSitsInItsSlot) {
  host_.send("right_info", info());
  see(0.5, 2);
  ASSERT_NE(FirstLandmark::asked.finder, nullptr);
  EXPECT_EQ(FirstLandmark::asked.finder->find({}, {}).error().text, "none");
}

TEST_F(FacePoseHostTest, HasNoFinderToLendWhereItsSlotIsEmpty) {
  host_.send("right_info", info());
  see(0.5, 2);
  EXPECT_EQ(FirstLandmark::asked.finder, nullptr);
}

TEST_F(FacePoseHostTest, TellsThePoseUnderTheHeaderOfThePictures) {
  host_.send("right_info", info());
  const msg::FacePose face = see(0.5, 2);
  EXPECT_EQ(face.header_(), image(0.5).header_());
  EXPECT_TRUE(face.valid_());
  EXPECT_EQ(face.reason_(), "");
  EXPECT_EQ(to_eigen(face.left_eye_()), (Vector3d{1, 2, 3}));
  EXPECT_EQ(to_eigen(face.right_eye_()), (Vector3d{4, 5, 6}));
  EXPECT_EQ(to_eigen(face.mouth_()), (Vector3d{2, 0, 1}));
  EXPECT_EQ(to_eigen(face.normal_()), (Vector3d{0, 0, -1}));
  EXPECT_EQ(face.code_(), 0);
  EXPECT_EQ(face.residual_px_(), 0.25);
  EXPECT_EQ(face.mouth_covariance_(), (std::array<double, 9>{1, 0, 0, 0, 2, 0, 0, 0, 3}));
  EXPECT_EQ(face.normal_covariance_(), (std::array<double, 9>{1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

TEST_F(FacePoseHostTest, AsksWithThePairItsLandmarksAndItsCamera) {
  host_.send("right_info", info());
  see(0.5, 2);
  const FacePoseInput& asked = FirstLandmark::asked;
  EXPECT_EQ(asked.camera.width, 4);
  EXPECT_EQ(asked.camera.height, 2);
  EXPECT_EQ(asked.camera.focal_px, 500);
  EXPECT_EQ(asked.camera.cx, 1.5);
  EXPECT_EQ(asked.camera.cy, 0.5);
  EXPECT_DOUBLE_EQ(asked.camera.baseline_m, 0.12);
  EXPECT_EQ(asked.left.width, 4);
  EXPECT_EQ(asked.right.height, 2);
  EXPECT_EQ(asked.landmarks.right.points[67].point, (Eigen::Vector2d{0.25, 0.25}));
  EXPECT_EQ(asked.landmarks.right.points[67].sigma, 0.4);
  EXPECT_EQ(asked.landmarks.left.box.width, 3);
  EXPECT_EQ(asked.landmarks.left.score, 1.5);
  EXPECT_EQ(asked.landmarks.left.mean_intensity, 80);
}

TEST_F(FacePoseHostTest, WaitsForPicturesAndLandmarksOfOneStampAndAnswersThemOnce) {
  host_.send("right_info", info());
  host_.send("left_image", image(1));
  host_.send("right_image", image(1));
  host_.send("landmarks", landmarks(0.9, 2));
  EXPECT_FALSE(host_.triggered());
  host_.step(1);
  EXPECT_TRUE(host_.take<msg::FacePose>("face").empty());
  host_.send("landmarks", landmarks(1, 2));
  host_.step(1.1);
  EXPECT_EQ(host_.take<msg::FacePose>("face").size(), 1u);
  host_.step(1.2);
  EXPECT_TRUE(host_.take<msg::FacePose>("face").empty());
}

TEST_F(FacePoseHostTest, SaysWhyThereIsNoPoseAndTellsNothingOfTheOneBefore) {
  const msg::FacePose early = see(1, 2);
  EXPECT_EQ(early.reason_(), "no camera_info yet");
  EXPECT_EQ(early.code_(), 2) << "bad input";
  host_.send("right_info", info());
  ASSERT_TRUE(see(2, 2).valid_());
  const msg::FacePose none = see(3, -1);
  EXPECT_FALSE(none.valid_());
  EXPECT_EQ(none.reason_(), "a hand is before the mouth");
  EXPECT_EQ(none.code_(), 3) << "covered";
  EXPECT_EQ(to_eigen(none.mouth_()), Vector3d::Zero());
  EXPECT_EQ(to_eigen(none.normal_()), Vector3d::Zero());
  EXPECT_EQ(none.mouth_covariance_(), (std::array<double, 9>{}));
}

TEST_F(FacePoseHostTest, AnswersBadInputWithItsReason) {
  host_.send("right_info", info());
  double stamp = 10;
  int code = 0;
  const auto refusal = [&](auto change) {
    ++stamp;
    msg::Image left = image(stamp), right = image(stamp);
    msg::FaceLandmarks found = landmarks(stamp, 2);
    change(left, right, found);
    const msg::FacePose face = see(left, right, found);
    EXPECT_FALSE(face.valid_());
    EXPECT_EQ(stamp_of(face.header_().stamp_()), Time{} + seconds(stamp));
    code = face.code_();
    return face.reason_();
  };
  EXPECT_EQ(refusal([](auto&, auto&, auto& found) {
              found.valid_(false);
              found.reason_("no face in the right image");
            }),
            "no face in the right image");
  EXPECT_EQ(code, 1) << "no face";
  EXPECT_EQ(refusal([](auto&, auto&, auto& found) { found.right_().pop_back(); }),
            "right: 135 coordinates and 68 sigmas of landmarks, and ibug68 has 136 and 68");
  EXPECT_EQ(refusal([](auto&, auto&, auto& found) { found.left_sigma_().clear(); }),
            "left: 136 coordinates and 0 sigmas of landmarks, and ibug68 has 136 and 68");
  EXPECT_EQ(refusal([](auto&, auto&, auto& found) { found.scheme_("mesh9"); }),
            "no landmark scheme is 'mesh9'");
  EXPECT_EQ(refusal([](auto& left, auto&, auto&) { left.encoding_("bgr8"); }),
            "left: the image is 'bgr8', not mono8");
  EXPECT_EQ(refusal([](auto&, auto& right, auto&) { right.data_().clear(); }),
            "right: an image of 4 x 2 pixels with 0 bytes in steps of 4");
  EXPECT_EQ(code, 2) << "bad input";
  EXPECT_TRUE(see(50, 2).valid_());
}

TEST_F(FacePoseHostTest, RefusesACameraThatIsNoneOrAnotherOne) {
  double stamp = 20;
  const auto refusal = [&](auto change) {
    msg::CameraInfo wrong = info();
    change(wrong);
    host_.send("right_info", wrong);
    const msg::FacePose face = see(++stamp, 2);
    EXPECT_FALSE(face.valid_());
    return face.reason_();
  };
  EXPECT_EQ(refusal([](auto& i) { i.p_()[3] = 0; }),
            "the right camera's info has f = 500 px and P[3] = 0; a rectified pair has f > 0 and "
            "P[3] = -f b < 0");
  EXPECT_EQ(refusal([](auto& i) { i.p_()[0] = NAN; }),
            "the right camera's info has f = nan px and P[3] = -60; a rectified pair has f > 0 and "
            "P[3] = -f b < 0");
  EXPECT_EQ(refusal([](auto& i) { i.p_()[2] = NAN; }), "the right camera's info is not finite");
  EXPECT_EQ(refusal([](auto& i) { i.width_(640); }),
            "the right camera's info is for 640 x 2 pixels, the image has 4 x 2");
  host_.send("right_info", info());
  EXPECT_TRUE(see(50, 2).valid_());
}

TEST_F(FacePoseHostTest, AnExceptionOfTheEstimatorIsAReasonAndTheNextPicturesAreAnswered) {
  host_.send("right_info", info());
  FirstLandmark::throws = true;
  const msg::FacePose answer = see(1, 2);
  FirstLandmark::throws = false;
  EXPECT_FALSE(answer.valid_());
  EXPECT_EQ(answer.reason_(), "the plugin threw: the matrix is singular");
  const msg::FacePose next = see(2, 2);
  EXPECT_TRUE(next.valid_());
  EXPECT_EQ(next.normal_covariance_()[0], 1) << "it starts cold";
}

TEST_F(FacePoseHostTest, KeepsWhatTheEstimatorRemembers) {
  host_.send("right_info", info());
  EXPECT_EQ(see(1, 2).normal_covariance_()[0], 1);
  EXPECT_EQ(see(2, 2).normal_covariance_()[0], 2);
}

/// Pictures of 256 x 32 pixels with noise, or without.
class FacePoseHostAndCameras : public FacePoseHostTest {
 protected:
  static constexpr int kSeed = 5;

  FacePoseHostAndCameras() {
    msg::CameraInfo of_both = info();
    of_both.width_(256);
    of_both.height_(32);
    host_.send("right_info", of_both);
    take();
  }
  ~FacePoseHostAndCameras() override { FirstLandmark::rows.reset(); }

  /// The cameras take a new picture, or only one of them does. Without noise it is grey, with a
  /// thing at a column.
  void take(bool of_left = true, bool of_right = true, double noise = 2, int thing_at = 20) {
    std::normal_distribution<double> error{0, noise};
    for (auto& [picture, is_taken] : {std::pair{&left_, of_left}, {&right_, of_right}}) {
      if (!is_taken) continue;
      picture->width_(256);
      picture->height_(32);
      picture->step_(256);
      picture->encoding_("mono8");
      picture->data_().assign(256 * 32, 0);
      for (std::size_t i = 0; i < picture->data_().size(); ++i) {
        const bool shows_thing = std::abs(static_cast<int>(i % 256) - thing_at) < 8;
        picture->data_()[i] = static_cast<std::uint8_t>(
            std::lround((shows_thing ? 60 : 120) + (noise > 0 ? error(random_) : 0)));
      }
    }
  }
  /// What the host says of the pictures that are there, 0.1 s after the last ones.
  msg::FacePose look() {
    stamp_ += 0.1;
    for (auto* picture : {&left_, &right_}) picture->header_() = image(stamp_).header_();
    return see(left_, right_, landmarks(stamp_, 2));
  }
  void look_at_noise(int pairs) {
    for (int i = 0; i < pairs; ++i) {
      take();
      EXPECT_TRUE(look().valid_()) << "seed " << kSeed << ", pair " << i;
    }
  }

  msg::Image left_, right_;
  std::mt19937 random_{kSeed};
  double stamp_ = 0;
};

TEST_F(FacePoseHostAndCameras, OneThatIsFrozenIsRefusedAtOnceAndToldOfWhenItStays) {
  ASSERT_TRUE(look().valid_());
  take(false, true);
  EXPECT_EQ(look().reason_(),
            "the left camera is frozen: repeat 1 of the same picture, to the last bit, though the "
            "other camera's changes; look at its cable, and start its driver again");
  for (int repeat = 2; repeat <= 3; ++repeat) {
    EXPECT_EQ(host_.status().reason, "") << repeat;
    take(false, true);
    EXPECT_FALSE(look().valid_());
  }
  EXPECT_THAT(host_.status().reason,
              testing::StartsWith("the left camera is frozen: repeat 3 of the same picture"));
  take(true, true);
  EXPECT_TRUE(look().valid_());
  EXPECT_EQ(host_.status().reason, "");
  take(true, false);
  EXPECT_THAT(look().reason_(), testing::HasSubstr("the right camera is frozen: repeat 1 of"));
}

TEST_F(FacePoseHostAndCameras, BothFrozenIsSeenByTheNoiseThatIsNoMoreThere) {
  look_at_noise(4);
  EXPECT_THAT(look().reason_(),
              testing::HasSubstr("both cameras are frozen: repeat 1 of the same picture"));
  EXPECT_FALSE(look().valid_());
  take();
  EXPECT_TRUE(look().valid_());
}

TEST_F(FacePoseHostAndCameras, AStillSceneWithoutNoiseIsNotFrozen) {
  take(true, true, 0);
  for (int i = 0; i < 40; ++i) EXPECT_TRUE(look().valid_()) << i;
  // Something moves through it and comes to rest again, on a grey wall.
  for (int i = 0; i < 12; ++i) {
    take(true, true, 0, 20 + i);
    EXPECT_TRUE(look().valid_()) << i;
  }
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(look().valid_()) << i;
  // It moves by a column in the left picture only, as where an arm comes to rest.
  take(true, false, 0, 32);
  EXPECT_TRUE(look().valid_());
}

TEST_F(FacePoseHostAndCameras, RowsThatDifferOnAverageAreToldAndNoPairIsRefusedForThem) {
  const auto state_after = [&](const RowDifference& rows, int pairs) {
    FirstLandmark::rows = rows;
    look_at_noise(pairs);
    return host_.status().reason;
  };
  EXPECT_EQ(state_after({.at_face_px = 0.3}, 19), "");
  EXPECT_EQ(state_after({.at_face_px = 0.3}, 1),
            "the cameras are no longer well calibrated: on average the rows of their pictures "
            "differ by 0.30 px at the face (at most 0.15), and by 0.0 px more on one side of the "
            "picture than on the other (at most 1); calibrate them again with 'armature calibrate "
            "stereo', before faces are refused");
  EXPECT_EQ(state_after({}, 150), "");
  EXPECT_THAT(state_after({.by_column = 0.0075}, 60), testing::HasSubstr("by 1.0 px more on one"));
}

}  // namespace
}  // namespace armature::face_pose_host
