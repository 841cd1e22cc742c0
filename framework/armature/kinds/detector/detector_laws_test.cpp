// SPDX-License-Identifier: Apache-2.0
// The laws of detectors find those that break them, and say what they cannot check.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string_view>
#include <vector>

#include "armature/kinds/detector/laws.hpp"

namespace armature {
namespace {

using testing::ElementsAre, testing::IsEmpty;

/// Sees no face in any picture.
class Blind : public FaceDetector {
 public:
  Expected<std::vector<DetectedFace>> detect(const ImageView& image, const SearchRegion&) override {
    if (auto wrong = invalid_input(image)) return refuse(*wrong);
    return std::vector<DetectedFace>{};
  }
};

/// Takes everything for a face, and for an image.
class Credulous : public FaceDetector {
 public:
  Expected<std::vector<DetectedFace>> detect(const ImageView&, const SearchRegion& all) override {
    return std::vector<DetectedFace>{{.box = all.box, .score = 1}};
  }
};

struct Verdict {
  std::vector<std::string_view> skipped, broken, unasked;
};

Verdict verdict(const DetectorSubject& subject) {
  Verdict verdict;
  for (const Law<DetectorSubject>& law : detector_laws()) {
    const LawReport report = check_law(law, subject);
    if (!report.skipped.empty()) {
      EXPECT_EQ(report.skipped, "no picture of a face was given");
      verdict.skipped.push_back(law.name);
    } else if (report.questions == 0) {
      verdict.unasked.push_back(law.name);
    }
    if (!report.kept()) verdict.broken.push_back(law.name);
  }
  return verdict;
}

/// Whose picture, if there is one, shows a wall.
template <class Detector>
DetectorSubject subject(bool with_picture) {
  static Detector detector;
  DetectorSubject subject{
      .name = "one", .detector = []() -> FaceDetector& { return detector; }, .face = {}};
  if (with_picture) subject.face = [] { return Picture::of_one_grey(90); };
  return subject;
}

TEST(DetectorLawsThemselves, WithoutAPictureSkipWhatIsAboutTheFaceAndAskTheRest) {
  const Verdict blind = verdict(subject<Blind>(false));
  EXPECT_THAT(blind.skipped,
              ElementsAre("FindsTheFaceWhereItIs", "FindsItAgainInARegionAroundItAndNotInOneAside",
                          "EqualPicturesGiveEqualBitsWhateverWasSeenInBetween",
                          "RowsMayBeLongerThanThePictureIsWide", "ARegionThatIsNoneHasNoFaces"));
  EXPECT_THAT(blind.broken, IsEmpty());
  EXPECT_THAT(blind.unasked, IsEmpty());
}

TEST(DetectorLawsThemselves, FindADetectorThatMissesTheFace) {
  const Verdict blind = verdict(subject<Blind>(true));
  EXPECT_THAT(blind.skipped, IsEmpty());
  EXPECT_THAT(blind.broken, ElementsAre("FindsTheFaceWhereItIs",
                                        "FindsItAgainInARegionAroundItAndNotInOneAside"));
}

TEST(DetectorLawsThemselves, FindADetectorThatTakesEverythingForAFace) {
  EXPECT_THAT(verdict(subject<Credulous>(false)).broken,
              ElementsAre("APictureWithoutAFaceHasNone", "PicturesTooSmallForAFaceHaveNone",
                          "RefusesViewsThatAreNoImage"));
}

}  // namespace
}  // namespace armature
