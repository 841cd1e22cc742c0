// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <ostream>
#include <string>

#include "armature/kinds/detector/detector.hpp"
#include "armature/kinds/face_picture.hpp"

// The laws that every `detector` plugin keeps. In the plugin's test, in one source file:
//
//   INSTANTIATE_TEST_SUITE_P(Hog, DetectorLaws, testing::Values(...));
namespace armature {

/// A detector (made once, when it is needed first), a picture with one face, and a point [px] in
/// the middle of that face.
struct DetectorSubject {
  std::string name;
  std::function<FaceDetector&()> detector;
  std::function<Picture()> face;
  double middle_x = 0, middle_y = 0;

  friend void PrintTo(const DetectorSubject& subject, std::ostream* out) { *out << subject.name; }
};

class DetectorLaws : public testing::TestWithParam<DetectorSubject> {
 protected:
  FaceDetector& detector() const { return GetParam().detector(); }
  static SearchRegion everywhere(const ImageView& view);
  /// The one face of the subject's picture.
  DetectedFace only_face() const;
  bool holds_middle(const PixelBox& box) const;
  static void expect_same(const std::vector<DetectedFace>& a, const std::vector<DetectedFace>& b);

  const Picture face_ = GetParam().face();
};

}  // namespace armature
