// SPDX-License-Identifier: Apache-2.0
// The finder with a network of the tests that has the inputs and outputs of the face mesh:
// 1. the laws of every landmark finder, 2. what it states and refuses, 3. files that are no face
// mesh; then with the face mesh itself where tools/fetch-face-mesh has put it: 4. the laws, and
// points where a face was drawn.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "armature/kinds/declared_params.hpp"
#include "armature/kinds/drawn_face.hpp"
#include "armature/kinds/landmarks/contract.hpp"
#include "armature/runtime/plugins/plugin_library.hpp"
#include "landmarks_face_mesh_parameters.hpp"
#include "stand_in_test.hpp"

namespace armature::landmarks::face_mesh {
namespace {

using testing::AllOf, testing::HasSubstr, testing::StartsWith;

const std::string kManifest = source_folder() + "plugin.yaml";
const std::string kFetched = Parameters::read(declared_params(kManifest, "")).model;

Expected<PluginPtr<LandmarkFinder>> made_with(const std::string& params) {
  auto library = PluginLibrary::load(
      std::filesystem::path{ARMATURE_PLUGIN_BUILD_DIR} / "landmarks_face_mesh.so",
      LandmarkFinder::kKind);
  if (!library) return tl::unexpected{library.error()};
  const auto factory = reinterpret_cast<LandmarkFinder::Factory>((*library)->factory());
  auto made = factory(declared_params(kManifest, params));
  if (!made) return tl::unexpected{made.error()};
  return PluginPtr<LandmarkFinder>{*library, std::move(*made)};
}

PluginPtr<LandmarkFinder> finder_with(const std::string& params) {
  auto finder = made_with(params);
  if (!finder) throw std::runtime_error(finder.error().text);
  return std::move(*finder);
}

LandmarkFinder& stand_in() {
  static const PluginPtr<LandmarkFinder> shared = [] {
    const std::string file = stand_in_onnx("stand_in.onnx");
    auto finder = finder_with("model: " + file);
    std::filesystem::remove(file);
    return finder;
  }();
  return *shared;
}

LandmarkFinder& fetched() {
  static const auto shared = finder_with("");
  return *shared;
}

INSTANTIATE_TEST_SUITE_P(FaceMeshStandIn, LandmarkLaws,
                         testing::Values(LandmarkSubject{
                             .name = "stand_in",
                             .finder = &stand_in,
                             .face = [] { return DrawnPortrait{}.picture; },
                             .box = DrawnPortrait{}.box}),
                         testing::PrintToStringParamName());

/// One grey on the left, another on the right; 200 in between.
Picture halves(std::uint8_t left, std::uint8_t right) {
  Picture picture = Picture::of_one_grey(200, 300, 300);
  for (int i = 0; i < 300 * 300; ++i) {
    const int column = i % 300;
    if (column < 110) picture.pixels[static_cast<std::size_t>(i)] = left;
    if (column >= 190) picture.pixels[static_cast<std::size_t>(i)] = right;
  }
  return picture;
}

constexpr PixelBox kAll{50, 50, 200, 200};  // the network sees 360 x 360 px about (150, 150) first
/// [px] of the image for a pixel that the network sees at last: the stand-in's mesh is 137 px high.
constexpr double kPerPixel = 360 * 1.4 * 137 / 192 / 192;

TEST(FaceMesh, TellsPointsInPixelsOfTheImage) {
  const auto found = stand_in().find(halves(200, 200).view(), kAll);
  ASSERT_TRUE(found) << found.error().text;
  const FaceLandmarks face{.scheme = LandmarkScheme::mesh468, .points = *found, .box = kAll};
  // Of 192 pixels the middle is 95.5.
  const auto at = [](double x, double y) {
    return Eigen::Vector2d{150 + (x - 95.5) * kPerPixel, 150 + (y - 95.5) * kPerPixel};
  };
  EXPECT_LT((face.feature(FaceFeature::left_eye).point - at(65.5, 80)).norm(), 1e-3);
  EXPECT_LT((face.feature(FaceFeature::right_eye).point - at(125.5, 80)).norm(), 1e-3);
  EXPECT_LT((face.feature(FaceFeature::mouth).point - at(95.5, 130)).norm(), 1e-3);
  EXPECT_EQ(found->front().sigma, 0.05);  // min_sigma_px
}

TEST(FaceMesh, StatesTheSigmaByWhichThePictureAndTheMirroredOneDiffer) {
  const auto found = stand_in().find(halves(240, 189).view(), kAll);
  ASSERT_TRUE(found) << found.error().text;
  // Brighter by 0.2 of white on the left: 4 px down, and as much up when it is mirrored.
  EXPECT_NEAR(found->front().sigma, 2 * 4 / std::sqrt(8.0) * kPerPixel, 1e-3);
  // The first look moves the second one by 4 px.
  EXPECT_NEAR((*found)[13].point.y(), 150 + 4 * 360.0 / 192 + (130 - 95.5) * kPerPixel, 1e-3);
}

TEST(FaceMesh, RefusesAPictureWhoseMirroredOneShowsAnotherFace) {
  // 10 px up and down of eyes that are 60 px apart.
  const auto finder =
      finder_with("{max_asymmetry: 0.2, model: " + stand_in_onnx("asymmetry.onnx") + "}");
  const auto found = finder->find(halves(225, 97).view(), kAll);
  std::filesystem::remove(temporary("asymmetry.onnx"));
  ASSERT_FALSE(found);
  EXPECT_EQ(
      found.error().text,
      "the mirrored picture shows the face elsewhere, by 33 % of the distance of the eyes, more "
      "than 20 %");
}

TEST(FaceMesh, RefusesAPictureWithoutAFace) {
  const auto found = stand_in().find(Picture::of_one_grey(30).view(), {10, 10, 100, 100});
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().text, "the presence of a face is 0.01, less than 0.50");
}

std::string refusal_of_file(const std::string& file) {
  const auto made = made_with("model: " + file);
  return made ? "no refusal" : made.error().text;
}

const std::string kWayOut = "; expected is the file that tools/fetch-face-mesh makes";

TEST(FaceMesh, NamesAMissingFileAndTheCommandThatMakesIt) {
  EXPECT_EQ(refusal_of_file("/no/such.onnx"), "cannot open the face mesh /no/such.onnx" + kWayOut);
}

TEST(FaceMesh, RefusesAFileThatIsNoNetworkOrACutOne) {
  const std::string whole = stand_in_onnx("whole.onnx");
  std::ostringstream bytes;
  bytes << std::ifstream{whole, std::ios::binary}.rdbuf();
  for (const std::string& wrong : {std::string{"not a network at all"}, std::string{},
                                   bytes.str().substr(0, bytes.str().size() / 2)}) {
    const std::string file = written("wrong.onnx", wrong);
    EXPECT_THAT(
        refusal_of_file(file),
        AllOf(StartsWith(file + " is no face mesh that OpenCV can run ("), HasSubstr(kWayOut)));
    std::filesystem::remove(file);
  }
  std::filesystem::remove(whole);
}

TEST(FaceMesh, RefusesANetworkOfOtherPoints) {
  const std::string file = stand_in_onnx("other.onnx", 68);
  EXPECT_EQ(
      refusal_of_file(file),
      file +
          " is another network than the face mesh: none of its outputs are the points, and 468 "
          "points and the presence of a face were expected" +
          kWayOut);
  std::filesystem::remove(file);
}

TEST(FaceMesh, IsFetchedOnlyFromThePackageThatItsHashNames) {
  const std::string package = written("other.tgz", "another package");
  const Told told =
      told_by("python3 -B " + std::string{ARMATURE_SOURCE_DIR} +
              "/tools/fetch-face-mesh --package " + package + " " + temporary("not_written.onnx"));
  EXPECT_FALSE(told.succeeded);
  EXPECT_THAT(told.text, HasSubstr(package + " is not @mediapipe/face_mesh@"));
  EXPECT_FALSE(std::filesystem::exists(temporary("not_written.onnx")));
  std::filesystem::remove(package);
}

/// A law of the kind, with the network that was fetched.
class FetchedFaceMesh : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kFetched)) {
      GTEST_SKIP() << "there is no " << kFetched << "; tools/fetch-face-mesh makes it";
    }
  }
};

TEST_F(FetchedFaceMesh, KeepsTheLawsOfLandmarkFinders) {
  const LandmarkSubject subject{.name = "face_mesh",
                                .finder = &fetched,
                                .face = [] { return DrawnPortrait{}.picture; },
                                .box = DrawnPortrait{}.box};
  for (const Law<LandmarkSubject>& law : landmark_laws()) {
    SCOPED_TRACE(law.says);
    expect_kept(check_law(law, subject));
  }
}

TEST_F(FetchedFaceMesh, FindsEyesAndMouthWhereTheyWereDrawn) {
  const double z = 0.5;
  const auto found = fetched().find(DrawnPortrait{}.picture.view(), DrawnPortrait{}.box);
  ASSERT_TRUE(found) << found.error().text;
  const FaceLandmarks face{.scheme = LandmarkScheme::mesh468, .points = *found, .box = {}};
  const auto error = [&](FaceFeature feature, double x, double y) {
    const Eigen::Vector2d drawn = kDrawnCamera.project_left({0.06 + x, y, z});
    return (face.feature(feature).point - drawn).norm();
  };
  // 3 px are 1.6 mm of a face whose eyes are 115 px apart.
  EXPECT_LT(error(FaceFeature::left_eye, -0.0315, -0.065), 3);
  EXPECT_LT(error(FaceFeature::right_eye, 0.0315, -0.065), 3);
  EXPECT_LT(error(FaceFeature::mouth, 0, 0), 3);
  EXPECT_LT(face.points.front().sigma, 3);
}

TEST_F(FetchedFaceMesh, ShowsAMirroredFaceByTheMirroredPoints) {
  const DrawnPortrait drawn;
  Picture picture = drawn.picture;
  for (auto row = picture.pixels.begin(); row != picture.pixels.end(); row += picture.width) {
    std::reverse(row, row + picture.width);
  }
  PixelBox box = drawn.box;
  box.left = picture.width - 1 - drawn.box.right();
  const auto found = fetched().find(drawn.picture.view(), drawn.box);
  const auto mirrored = fetched().find(picture.view(), box);
  ASSERT_TRUE(found && mirrored);
  for (std::size_t i = 0; i < kPoints; ++i) {
    const Eigen::Vector2d& point = (*mirrored)[kMirroredPoints[i]].point;
    // The square that is looked at last depends on the first look, which is at one picture only:
    // by some 2 % of the distance of the eyes, which is 115 px.
    EXPECT_NEAR((*found)[i].point.x(), picture.width - 1 - point.x(), 3) << "point " << i;
    EXPECT_NEAR((*found)[i].point.y(), point.y(), 3) << "point " << i;
  }
}

TEST_F(FetchedFaceMesh, FindsNoFaceInNoise) {
  const auto found = fetched().find(Picture::of_noise(1).view(), {100, 60, 100, 100});
  EXPECT_FALSE(found);
}

}  // namespace
}  // namespace armature::landmarks::face_mesh
