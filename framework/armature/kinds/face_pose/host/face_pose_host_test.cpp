// SPDX-License-Identifier: Apache-2.0
// The host of the face pose estimators: 1. one answer for each pair of pictures with its landmarks,
// under their header, 2. the camera is that of the right camera's info, 3. what cannot be estimated
// is answered with its exact reason.
#include "face_pose_host_bench_test.hpp"

namespace armature::face_pose_host {
namespace {

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

}  // namespace
}  // namespace armature::face_pose_host
