// SPDX-License-Identifier: Apache-2.0
// The detector, loaded as the plugin that it is (dlib is compiled once): 1. the laws of every
// detector, 2. small faces.
#include <gtest/gtest.h>

#include <filesystem>

#include "armature/kinds/declared_params.hpp"
#include "armature/kinds/detector/contract.hpp"
#include "armature/kinds/drawn_face.hpp"
#include "armature/runtime/plugins/plugin_library.hpp"

namespace armature::detector::hog {
namespace {

PluginPtr<FaceDetector> make(std::string_view params = "") {
  auto library = PluginLibrary::load(
      std::filesystem::path{ARMATURE_PLUGIN_BUILD_DIR} / "detector_hog.so", FaceDetector::kKind);
  if (!library) throw std::runtime_error(library.error().text);
  const auto factory = reinterpret_cast<FaceDetector::Factory>((*library)->factory());
  return {*library,
          factory(declared_params(ARMATURE_SOURCE_DIR "/plugins/detector/hog/plugin.yaml", params))
              .value()};
}

FaceDetector& detector() {
  static const auto shared = make();
  return *shared;
}

INSTANTIATE_TEST_SUITE_P(Hog, DetectorLaws,
                         testing::Values(DetectorSubject{
                             .name = "hog",
                             .detector = &detector,
                             .face = [] { return DrawnPortrait{}.picture; },
                             .middle_x = DrawnPortrait{}.middle.x(),
                             .middle_y = DrawnPortrait{}.middle.y()}),
                         testing::PrintToStringParamName());

TEST(Hog, EnlargesThePictureForFacesSmallerThanItsWindow) {
  const Picture far = drawn_face(placed(0.06, 0, 2.6)).left;
  const SearchRegion everywhere{.box = {0, 0, 1279, 719}};
  EXPECT_TRUE(detector().detect(far.view(), everywhere)->empty());
  const auto patient = make("min_face_px: 40");
  const auto faces = patient->detect(far.view(), everywhere);
  ASSERT_EQ(faces->size(), 1u);
  EXPECT_LT(faces->front().box.width, 80);
}

}  // namespace
}  // namespace armature::detector::hog
