// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <ostream>
#include <string>

#include "armature/kinds/face_picture.hpp"
#include "armature/kinds/landmarks/landmarks.hpp"

// The laws that every `landmarks` plugin keeps. In the plugin's test, in one source file:
//
//   INSTANTIATE_TEST_SUITE_P(Dlib68, LandmarkLaws, testing::Values(...));
namespace armature {

/// A finder (made once, when it is needed first), a picture with a face, and where the face is.
struct LandmarkSubject {
  std::string name;
  std::function<LandmarkFinder&()> finder;
  std::function<Picture()> face;
  PixelBox box;

  friend void PrintTo(const LandmarkSubject& subject, std::ostream* out) { *out << subject.name; }
};

class LandmarkLaws : public testing::TestWithParam<LandmarkSubject> {
 protected:
  LandmarkFinder& finder() const { return GetParam().finder(); }
  static void expect_same(const std::vector<Landmark>& a, const std::vector<Landmark>& b);

  const Picture face_ = GetParam().face();
  const PixelBox box_ = GetParam().box;
};

}  // namespace armature
