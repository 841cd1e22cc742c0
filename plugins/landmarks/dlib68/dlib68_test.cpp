// SPDX-License-Identifier: Apache-2.0
// The landmark finder, loaded as the plugin that it is (dlib is compiled once): 1. the laws of
// every landmark finder, 2. landmarks lie where the face was drawn, 3. it looks where the face was,
// and everywhere when it is lost, 4. light, 5. refusals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <vector>

#include "../../sim/photo_scene/photo.hpp"
#include "../../sim/photo_scene/plane_renderer.hpp"
#include "armature/kinds/declared_params.hpp"
#include "armature/kinds/landmarks/contract.hpp"
#include "armature/runtime/plugin_library.hpp"

namespace armature::landmarks::dlib68 {
namespace {

const std::string kFolder = std::string{ARMATURE_SOURCE_DIR} + "/plugins/landmarks/dlib68/";
const StereoCamera kCamera{
    .width = 1280, .height = 720, .focal_px = 914, .cu = 639.5, .cv = 359.5, .baseline_m = 0.12};

Expected<PluginPtr<LandmarkFinder>> make(std::string_view params = "") {
  auto library =
      PluginLibrary::load(std::filesystem::path{ARMATURE_PLUGIN_BUILD_DIR} / "landmarks_dlib68.so",
                          LandmarkFinder::kKind, LandmarkFinder::kKindVersion);
  if (!library) return tl::unexpected{library.error()};
  const auto factory = reinterpret_cast<LandmarkFinder::Factory>((*library)->factory());
  auto finder = factory(declared_params(kFolder + "plugin.yaml", params));
  if (!finder) return tl::unexpected{finder.error()};
  return PluginPtr<LandmarkFinder>{*library, std::move(*finder)};
}

/// One finder for all tests: its model is 100 MB.
LandmarkFinder& finder() {
  static const auto shared = make();
  if (!shared) throw std::runtime_error(shared.error().text);
  return **shared;
}

/// The drawn face before both cameras; `camera_T_photo` of the left one.
StereoPicture picture(const Eigen::Isometry3d& left_T_photo, double brightness = 1) {
  static const auto photo = sim::photo_scene::generated_face(1, 0.063);
  static sim::photo_scene::PlaneRenderer renderer{
      photo, {.noise = 2, .blur_px = 0.5, .background = 120}, 1};
  const std::vector<std::uint8_t> black(1280 * 720);
  StereoPicture pair{1280, 720, black, black};
  Eigen::Isometry3d right_T_photo = left_T_photo;
  right_T_photo.pretranslate(Eigen::Vector3d{-kCamera.baseline_m, 0, 0});
  renderer.render(left_T_photo, kCamera, brightness, 0, pair.left);
  renderer.render(right_T_photo, kCamera, brightness, 1, pair.right);
  return pair;
}

Eigen::Isometry3d placed(double x, double y, double z, double yaw = 0, double pitch = 0) {
  return Eigen::Translation3d{x, y, z} * (Eigen::AngleAxisd{yaw, Eigen::Vector3d::UnitY()} *
                                          Eigen::AngleAxisd{pitch, Eigen::Vector3d::UnitX()});
}

Eigen::Vector2d mean(const FaceLandmarks& face, std::size_t first, std::size_t last,
                     std::size_t step = 1) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double count = 0;
  for (std::size_t i = first; i <= last; i += step, ++count) sum += face.points[i];
  return sum / count;
}

/// Largest distance [px] of eyes and mouth in both images from where they are.
double worst_error(const StereoLandmarks& found, const Eigen::Isometry3d& left_T_photo) {
  double worst = 0;
  const auto compare = [&](const Eigen::Vector3d& on_photo, std::size_t first, std::size_t last,
                           std::size_t step) {
    const Eigen::Vector3d p = left_T_photo * on_photo;
    worst = std::max({worst, (mean(found.left, first, last, step) - kCamera.project_left(p)).norm(),
                      (mean(found.right, first, last, step) - kCamera.project_right(p)).norm()});
  };
  compare({-0.0315, -0.065, 0}, 36, 41, 1);
  compare({0.0315, -0.065, 0}, 42, 47, 1);
  compare({0, 0, 0}, 60, 66, 2);
  return worst;
}

INSTANTIATE_TEST_SUITE_P(
    Dlib68, LandmarkLaws,
    testing::Values(LandmarkSubject{
        .name = "dlib68", .finder = &finder, .face = [] { return picture(placed(0.06, 0, 0.5)); }}),
    testing::PrintToStringParamName());

TEST(Dlib68, FindsEyesAndMouthWhereTheyWereDrawn) {
  for (const auto& pose : {placed(0.06, 0, 0.5), placed(0, 0.03, 0.6, 0.2, 0.1),
                           placed(0.1, -0.02, 0.45, -0.25, -0.15)}) {
    LandmarkFinder::State state;
    const StereoPicture pair = picture(pose);
    const auto found = finder().find(pair.left_view(), pair.right_view(), state);
    ASSERT_TRUE(found) << found.error().text;
    EXPECT_LT(worst_error(*found, pose), 4.0);  // of a face 260 px wide
    EXPECT_GT(found->left.score, 0);
    EXPECT_GT(found->left.mean_intensity, 100);
    EXPECT_LT(found->left.mean_intensity, 200);
    EXPECT_TRUE(state.left && state.right);
  }
}

TEST(Dlib68, FindsTheSameFaceFromWhereItWasLast) {
  LandmarkFinder::State state;
  const StereoPicture first = picture(placed(0.06, 0, 0.5));
  ASSERT_TRUE(finder().find(first.left_view(), first.right_view(), state));
  for (int i = 1; i <= 5; ++i) {
    const auto pose = placed(0.06 + 0.01 * i, 0.005 * i, 0.5 + 0.01 * i);
    const StereoPicture next = picture(pose);
    const auto found = finder().find(next.left_view(), next.right_view(), state);
    ASSERT_TRUE(found) << found.error().text;
    EXPECT_LT(worst_error(*found, pose), 4.0);
  }
}

TEST(Dlib68, SearchesEverywhereWhenTheFaceIsNotWhereItWas) {
  LandmarkFinder::State state{.left = PixelBox{20, 20, 200, 200},
                              .right = PixelBox{900, 400, 90, 90}};
  const auto pose = placed(0.06, 0, 0.5);
  const StereoPicture pair = picture(pose);
  const auto found = finder().find(pair.left_view(), pair.right_view(), state);
  ASSERT_TRUE(found) << found.error().text;
  EXPECT_LT(worst_error(*found, pose), 4.0);
}

TEST(Dlib68, SaysWhichImageHasNoFaceAndForgetsWhereItWas) {
  const StereoPicture face = picture(placed(0.06, 0, 0.5)), wall = picture(placed(0, 0, -1));
  LandmarkFinder::State state;
  ASSERT_TRUE(finder().find(face.left_view(), face.right_view(), state));
  const auto none = finder().find(wall.left_view(), wall.right_view(), state);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().text, "no face in the left image");
  EXPECT_FALSE(state.left || state.right);
  const auto half = finder().find(face.left_view(), wall.right_view(), state);
  ASSERT_FALSE(half);
  EXPECT_EQ(half.error().text, "no face in the right image");
}

TEST(Dlib68, FindsAFaceInTheDark) {
  const auto pose = placed(0.06, 0, 0.5);
  for (const double brightness : {0.3, 0.15}) {
    SCOPED_TRACE(brightness);
    LandmarkFinder::State state;
    const StereoPicture pair = picture(pose, brightness);
    const auto found = finder().find(pair.left_view(), pair.right_view(), state);
    ASSERT_TRUE(found) << found.error().text;
    EXPECT_LT(worst_error(*found, pose), 5.0);
    EXPECT_LT(found->left.mean_intensity, 160 * brightness);  // of the picture as it came
  }
}

TEST(Dlib68, NamesAMissingModelAndThePackageThatHasIt) {
  const auto refused = make("model: /no/such.dat");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().text,
            "cannot open the landmark model /no/such.dat; the Debian package libdlib-data installs "
            "it as /usr/share/dlib/shape_predictor_68_face_landmarks.dat");
}

TEST(Dlib68, RefusesAFileThatIsNoModel) {
  const std::string file = testing::TempDir() + "no_model.dat";
  std::ofstream{file} << "not a model at all";
  const auto refused = make("model: " + file);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().text, testing::StartsWith(file + " is not a landmark model of dlib"));
  EXPECT_THAT(refused.error().text, testing::HasSubstr("libdlib-data"));
}

}  // namespace
}  // namespace armature::landmarks::dlib68
