// SPDX-License-Identifier: Apache-2.0
// The landmark finder with the detector of detector/hog, both loaded as the plugins that they are:
// 1. the laws of every landmark finder, 2. landmarks lie where the face was drawn, 3. the face is
// sought where it was, and everywhere when it is lost, 4. light, 5. refusals, 6. the numbers of a
// model are those that dlib reads.
#include <dlib/serialize.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <vector>

#include "armature/kinds/declared_params.hpp"
#include "armature/kinds/drawn_face.hpp"
#include "armature/kinds/landmarks/contract.hpp"
#include "armature/kinds/landmarks/stereo_face_finder.hpp"
#include "armature/runtime/plugins/plugin_library.hpp"
#include "numbers_file.hpp"

namespace armature::landmarks::dlib68 {
namespace {

const StereoCamera& kCamera = kDrawnCamera;

template <class Kind>
Expected<PluginPtr<Kind>> make(const std::string& name, std::string_view params = "") {
  auto library = PluginLibrary::load(std::filesystem::path{ARMATURE_PLUGIN_BUILD_DIR} /
                                         (std::string{Kind::kKind} + "_" + name + ".so"),
                                     Kind::kKind);
  if (!library) return tl::unexpected{library.error()};
  const auto factory = reinterpret_cast<typename Kind::Factory>((*library)->factory());
  const std::string manifest = std::string{ARMATURE_SOURCE_DIR} + "/plugins/" +
                               std::string{Kind::kKind} + "/" + name + "/plugin.yaml";
  auto made = factory(declared_params(manifest, params));
  if (!made) return tl::unexpected{made.error()};
  return PluginPtr<Kind>{*library, std::move(*made)};
}
Expected<PluginPtr<LandmarkFinder>> make_dlib68(std::string_view params) {
  return make<LandmarkFinder>("dlib68", params);
}

/// One finder for all tests: its model is 100 MB.
LandmarkFinder& landmark_finder() {
  static const auto shared = make_dlib68("");
  if (!shared) throw std::runtime_error(shared.error().text);
  return **shared;
}
FaceDetector& detector() {
  static const auto shared = make<FaceDetector>("hog");
  if (!shared) throw std::runtime_error(shared.error().text);
  return **shared;
}

Expected<StereoLandmarks> find(StereoFaceFinder::State& state, const DrawnPair& pair) {
  StereoFaceFinder finder{detector(), landmark_finder(), {.stretch_below = 100}};
  return finder.find(pair.left.view(), pair.right.view(), state);
}

/// Largest distance [px] of eyes and mouth in both images from where they are.
double worst_error(const StereoLandmarks& found, const Eigen::Isometry3d& left_T_photo) {
  double worst = 0;
  const auto compare = [&](FaceFeature feature, const Eigen::Vector3d& on_photo) {
    const Eigen::Vector3d p = left_T_photo * on_photo;
    worst = std::max({worst, (found.left.feature(feature).point - kCamera.project_left(p)).norm(),
                      (found.right.feature(feature).point - kCamera.project_right(p)).norm()});
  };
  compare(FaceFeature::left_eye, {-0.0315, -0.065, 0});
  compare(FaceFeature::right_eye, {0.0315, -0.065, 0});
  compare(FaceFeature::mouth, {0, 0, 0});
  return worst;
}

INSTANTIATE_TEST_SUITE_P(Dlib68, LandmarkLaws,
                         testing::Values(LandmarkSubject{
                             .name = "dlib68",
                             .finder = &landmark_finder,
                             .face = [] { return DrawnPortrait{}.picture; },
                             .box = DrawnPortrait{}.box}),
                         testing::PrintToStringParamName());

TEST(Dlib68, FindsEyesAndMouthWhereTheyWereDrawn) {
  for (const auto& pose : {placed(0.06, 0, 0.5), placed(0, 0.03, 0.6, 0.2, 0.1),
                           placed(0.1, -0.02, 0.45, -0.25, -0.15)}) {
    StereoFaceFinder::State state;
    const auto found = find(state, drawn_face(pose));
    ASSERT_TRUE(found) << found.error().text;
    EXPECT_LT(worst_error(*found, pose), 4.0);  // of a face 260 px wide
    EXPECT_GT(found->left.mean_intensity, 100);
    EXPECT_LT(found->left.mean_intensity, 200);
  }
}

TEST(Dlib68, FindsTheSameFaceFromWhereItWasLast) {
  StereoFaceFinder::State state;
  ASSERT_TRUE(find(state, drawn_face(placed(0.06, 0, 0.5))));
  for (int i = 1; i <= 5; ++i) {
    const auto pose = placed(0.06 + 0.01 * i, 0.005 * i, 0.5 + 0.01 * i);
    const auto found = find(state, drawn_face(pose));
    ASSERT_TRUE(found) << found.error().text;
    EXPECT_LT(worst_error(*found, pose), 4.0);
  }
}

TEST(Dlib68, FindsAFaceThatIsNotWhereItWas) {
  StereoFaceFinder::State state;
  ASSERT_TRUE(find(state, drawn_face(placed(-0.1, -0.08, 0.7))));
  const auto pose = placed(0.12, 0.05, 0.5);
  EXPECT_EQ(find(state, drawn_face(pose)).error().text,
            "the face is not in the left image, another one is");
  const auto found = find(state, drawn_face(pose));
  ASSERT_TRUE(found) << found.error().text;
  EXPECT_LT(worst_error(*found, pose), 4.0);
}

TEST(Dlib68, SaysWhichPictureHasNoFace) {
  StereoFaceFinder::State state;
  const DrawnPair face = drawn_face(placed(0.06, 0, 0.5)), wall = drawn_face(placed(0, 0, -1));
  ASSERT_TRUE(find(state, face));
  EXPECT_EQ(find(state, wall).error().text, "no face in the left image");
  EXPECT_EQ(find(state, {face.left, wall.right}).error().text, "no face in the right image");
}

TEST(Dlib68, FindsAFaceInTheDark) {
  const auto pose = placed(0.06, 0, 0.5);
  for (const double brightness : {0.3, 0.15}) {
    SCOPED_TRACE(brightness);
    StereoFaceFinder::State state;
    const auto found = find(state, drawn_face(pose, brightness));
    ASSERT_TRUE(found) << found.error().text;
    EXPECT_LT(worst_error(*found, pose), 5.0);
    EXPECT_LT(found->left.mean_intensity, 160 * brightness);  // of the picture as it came
  }
}

TEST(Dlib68, NamesAMissingModelAndThePackageThatHasIt) {
  const auto refused = make_dlib68("model: /no/such.dat");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().text,
            "cannot open the landmark model /no/such.dat; the Debian package libdlib-data installs "
            "it as /usr/share/dlib/shape_predictor_68_face_landmarks.dat");
}

TEST(Dlib68, RefusesAFileThatIsNoModel) {
  const std::string file = testing::TempDir() + "no_model.dat";
  std::ofstream{file} << "not a model at all";
  const auto refused = make_dlib68("model: " + file);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().text, testing::StartsWith(file + " is not a landmark model of dlib"));
  EXPECT_THAT(refused.error().text, testing::HasSubstr("libdlib-data"));
}

/// Numbers of every size and sign, more than a buffer of the file holds.
std::vector<float> many_numbers() {
  using Limits = std::numeric_limits<float>;
  std::vector<float> numbers{0,
                             -0.0F,
                             1,
                             -1,
                             256,
                             Limits::max(),
                             Limits::lowest(),
                             Limits::min(),
                             Limits::min() / 3,
                             Limits::denorm_min(),
                             Limits::infinity(),
                             -Limits::infinity()};
  std::mt19937 random{68};
  std::uniform_real_distribution<float> mantissa{-1, 1};
  std::uniform_int_distribution<int> exponent{-150, 128};
  while (numbers.size() < 300'000)
    numbers.push_back(std::ldexp(mantissa(random), exponent(random)));
  return numbers;
}

TEST(NumbersFile, GivesTheNumbersThatDlibHasWrittenOrLeavesThemToIt) {
  const std::string name = testing::TempDir() + "numbers.dat";
  const std::vector<float> written = many_numbers();
  std::ofstream out{name, std::ios::binary};
  for (const float number : written) dlib::serialize(number, out);
  out.close();
  ASSERT_GT(std::filesystem::file_size(name), 1U << 20U);

  NumbersFile file{name};
  std::istream stream{&file};
  int left_to_dlib = 0;
  for (const float number : written) {
    float read = 12345;
    if (!file.take(read)) {
      dlib::deserialize(read, stream);
      ++left_to_dlib;
    }
    ASSERT_EQ(read, number);
  }
  EXPECT_GT(left_to_dlib, 2);
  EXPECT_LT(left_to_dlib, 60'000) << "a number below 2^-103 has an exponent that no float has";
  EXPECT_EQ(stream.peek(), std::istream::traits_type::eof());
}

}  // namespace
}  // namespace armature::landmarks::dlib68
