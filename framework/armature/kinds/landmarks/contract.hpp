// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "armature/kinds/landmarks/landmarks.hpp"

// The laws that every `landmarks` plugin keeps. In the plugin's test, in one source file:
//
//   INSTANTIATE_TEST_SUITE_P(Dlib68, LandmarkLaws, testing::Values(...));
namespace armature {

/// The pixels of a stereo pair, rows one behind the other.
struct StereoPicture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> left, right;

  ImageView left_view() const { return view(left); }
  ImageView right_view() const { return view(right); }

 private:
  ImageView view(const std::vector<std::uint8_t>& pixels) const {
    return {.data = pixels.data(),
            .width = width,
            .height = height,
            .stride = static_cast<std::size_t>(width)};
  }
};

/// A finder (made once, when it is needed first), and a pair of pictures with a face that it finds.
struct LandmarkSubject {
  std::string name;
  std::function<LandmarkFinder&()> finder;
  std::function<StereoPicture()> face;

  friend void PrintTo(const LandmarkSubject& subject, std::ostream* out) { *out << subject.name; }
};

class LandmarkLaws : public testing::TestWithParam<LandmarkSubject> {
 protected:
  using State = LandmarkFinder::State;
  LandmarkFinder& finder() const { return GetParam().finder(); }
  Expected<StereoLandmarks> find(const StereoPicture& picture, State& state) const;
  static StereoPicture of_one_colour(std::uint8_t grey, int width = 320, int height = 240);
  static StereoPicture noise(std::uint64_t seed);
  void expect_no_face(const StereoPicture& picture) const;
  State after_a_face() const;
  static void expect_same(const FaceLandmarks& a, const FaceLandmarks& b);
  static void expect_same(const std::optional<PixelBox>& a, const std::optional<PixelBox>& b);
  void expect_in_picture(const FaceLandmarks& face) const;

  const StereoPicture face_ = GetParam().face();
};

}  // namespace armature
