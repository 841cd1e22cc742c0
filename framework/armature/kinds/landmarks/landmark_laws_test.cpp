// SPDX-License-Identifier: Apache-2.0
// The laws of landmark finders find those that break them, and say what they cannot check.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "armature/kinds/landmarks/laws.hpp"

namespace armature {
namespace {

using testing::ElementsAre, testing::IsEmpty;

/// Tells five landmarks from the box alone, also from one that is not finite.
class Guess : public LandmarkFinder {
 public:
  LandmarkScheme scheme() const override { return LandmarkScheme::five; }
  Expected<std::vector<Landmark>> find(const ImageView& image, const PixelBox& face) override {
    if (auto wrong = invalid_input(image)) return refuse(*wrong);
    const auto at = [&](double x, double y) {
      return Landmark{.point = {face.left + x * face.width, face.top + y * face.height},
                      .sigma = 1};
    };
    return std::vector<Landmark>{at(0.3, 0.4), at(0.7, 0.4), at(0.5, 0.6), at(0.4, 0.8),
                                 at(0.6, 0.8)};
  }
};

/// The same, but refuses a box that is not finite.
class CarefulGuess : public Guess {
 public:
  Expected<std::vector<Landmark>> find(const ImageView& image, const PixelBox& face) override {
    if (!std::isfinite(face.left + face.width)) return refuse("the box is not finite");
    return Guess::find(image, face);
  }
};

/// Exchanges the eyes, and moves the nose by a pixel each time.
class Confused final : public CarefulGuess {
 public:
  Expected<std::vector<Landmark>> find(const ImageView& image, const PixelBox& face) override {
    auto found = CarefulGuess::find(image, face);
    if (!found) return found;
    std::swap((*found)[0], (*found)[1]);
    (*found)[2].point.x() += ++calls_;
    return found;
  }

 private:
  int calls_ = 0;
};

struct Verdict {
  std::vector<std::string_view> skipped, broken;
};

/// Of the laws on a finder whose picture, if there is one, shows a wall.
template <class Finder>
Verdict verdict(bool with_picture) {
  Finder finder;
  LandmarkSubject subject{.name = "one",
                          .finder = [&]() -> LandmarkFinder& { return finder; },
                          .face = {},
                          .box = {100, 60, 100, 100}};
  if (with_picture) subject.face = [] { return Picture::of_one_grey(90); };
  Verdict verdict;
  for (const Law<LandmarkSubject>& law : landmark_laws()) {
    const LawReport report = check_law(law, subject);
    if (!report.skipped.empty()) {
      EXPECT_EQ(report.skipped, "no picture of a face was given");
      verdict.skipped.push_back(law.name);
    } else {
      EXPECT_GT(report.questions, 0) << law.name;
    }
    if (!report.kept()) verdict.broken.push_back(law.name);
  }
  return verdict;
}

TEST(LandmarkLawsThemselves, WithoutAPictureSkipWhatIsAboutTheFaceAndAskTheRest) {
  const Verdict careful = verdict<CarefulGuess>(false);
  EXPECT_THAT(careful.skipped, ElementsAre("FindsAsManyLandmarksAsItsSchemeHasNearTheBox",
                                           "TellsLeftEyeRightEyeAndMouthOfAnUprightFaceApart",
                                           "EqualPicturesGiveEqualBitsWhateverWasSeenInBetween",
                                           "RowsMayBeLongerThanThePictureIsWide"));
  EXPECT_THAT(careful.broken, IsEmpty());
}

TEST(LandmarkLawsThemselves, AreAllKeptByLandmarksAsAFaceHasThem) {
  const Verdict careful = verdict<CarefulGuess>(true);
  EXPECT_THAT(careful.skipped, IsEmpty());
  EXPECT_THAT(careful.broken, IsEmpty());
}

TEST(LandmarkLawsThemselves, FindLandmarksThatAreNotFinite) {
  EXPECT_THAT(verdict<Guess>(false).broken,
              ElementsAre("ABoxThatLiesElsewhereIsAnsweredWithFiniteLandmarksOrARefusal"));
}

TEST(LandmarkLawsThemselves, FindExchangedEyesAndAMemory) {
  EXPECT_THAT(verdict<Confused>(true).broken,
              ElementsAre("TellsLeftEyeRightEyeAndMouthOfAnUprightFaceApart",
                          "EqualPicturesGiveEqualBitsWhateverWasSeenInBetween",
                          "RowsMayBeLongerThanThePictureIsWide"));
}

}  // namespace
}  // namespace armature
