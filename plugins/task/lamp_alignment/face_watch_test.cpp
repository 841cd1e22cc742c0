// SPDX-License-Identifier: Apache-2.0
#include "face_watch.hpp"

#include <gtest/gtest.h>

namespace armature::task::lamp_alignment {
namespace {

/// Pictures ten times a second.
class FaceWatchTest : public testing::Test {
 protected:
  void see(double for_s, bool face) {
    for (double s = 0; s < for_s - 1e-9; s += 0.1) {
      now_ = now_ + seconds(0.1);
      watch_.see(Picture{.stamp = now_, .face = face}, now_);
    }
  }
  void measure(int measurements) {
    watch_.see(FaceEstimate{.stamp = now_, .measurements = measurements});
  }
  /// The same of pictures that show no face, and none of which can be used.
  void see_unusable(double for_s, const std::string& why) {
    for (double s = 0; s < for_s - 1e-9; s += 0.1) {
      see(0.1, false);
      watch_.see(Verdict{.stamp = now_, .refusal = why, .can_be_used = false});
    }
  }
  void wait(double for_s) { now_ = now_ + seconds(for_s); }

  FaceWatch watch_{Parameters{}};
  Time now_, begin_;
};

TEST_F(FaceWatchTest, AFaceIsLostOnceThePicturesHaveShownNoneForLong) {
  see(5, true);
  see(2, false);
  EXPECT_FALSE(watch_.lost(begin_));
  see(0.1, false);
  EXPECT_TRUE(watch_.lost(begin_));
  EXPECT_FALSE(watch_.lost(now_)) << "of an arm that came to rest just now";
}

TEST_F(FaceWatchTest, WithoutPicturesNoFaceIsLost) {
  see(5, true);
  wait(60);
  EXPECT_FALSE(watch_.lost(begin_));
  EXPECT_EQ(watch_.blindness(begin_, now_), "no picture has come for 2 s");
  EXPECT_EQ(watch_.blindness(now_, now_), "") << "the cameras were told to look just now";
}

TEST_F(FaceWatchTest, TheFirstPictureAfterAGapBeginsTheWaitAnew) {
  see(5, true);
  wait(60);
  see(0.1, false);
  EXPECT_EQ(watch_.blindness(begin_, now_), "");
  EXPECT_FALSE(watch_.lost(begin_));
  see(2.1, false);
  EXPECT_TRUE(watch_.lost(begin_));
}

TEST_F(FaceWatchTest, AFaceThatIsSeenIsNotLostThoughItIsNotBelieved) {
  see(1, true);
  measure(3);
  see(5, true);
  EXPECT_FALSE(watch_.lost(begin_));
  EXPECT_EQ(watch_.disbelief(begin_), "a face is seen but not believed: nobody tells where it is");
  watch_.see_no_estimate("something covers it");
  EXPECT_EQ(watch_.disbelief(begin_), "a face is seen but not believed: something covers it");
  wait(60);
  measure(6);
  EXPECT_EQ(watch_.disbelief(begin_), "");
}

TEST_F(FaceWatchTest, PicturesThatCannotBeUsedTellOfNoFaceThatIsLost) {
  see(5, true);
  see_unusable(1.9, "the left camera is frozen");
  EXPECT_EQ(watch_.blindness(begin_, now_), "");
  see_unusable(60, "the right camera is frozen");
  EXPECT_FALSE(watch_.lost(begin_));
  EXPECT_EQ(watch_.blindness(begin_, now_),
            "no picture could be used for 2 s: the right camera is frozen");
  EXPECT_EQ(watch_.blindness(now_, now_), "") << "the cameras were told to look just now";
  wait(3);
  EXPECT_EQ(watch_.blindness(begin_, now_), "no picture has come for 2 s");
}

TEST_F(FaceWatchTest, TheFirstPictureThatCanBeUsedAgainBeginsTheWaitAnew) {
  see(5, true);
  see_unusable(10, "the left camera is frozen");
  see(0.1, false);
  watch_.see(Verdict{.stamp = now_, .refusal = "no face in the left image"});
  EXPECT_EQ(watch_.blindness(begin_, now_), "");
  see(1.9, false);
  EXPECT_FALSE(watch_.lost(begin_));
  see(0.2, false);
  EXPECT_TRUE(watch_.lost(begin_));
}

TEST_F(FaceWatchTest, AFaceIsLostThoughAPictureNowAndThenCannotBeUsed) {
  see(5, true);
  measure(3);
  for (int k = 0; k < 120; ++k) {
    see(0.4, false);
    watch_.see(Verdict{.stamp = now_, .refusal = "no face in the left image"});
    see_unusable(0.1, "the left camera gives its last picture again");
  }
  EXPECT_TRUE(watch_.lost(begin_));
  EXPECT_EQ(watch_.disbelief(begin_), "") << "no face is seen";
}

TEST_F(FaceWatchTest, PicturesThatCannotBeUsedCountForNoTimeInWhichAFaceIsMissed) {
  see(5, true);
  for (int k = 0; k < 18; ++k) {
    see(0.1, false);
    watch_.see(Verdict{.stamp = now_, .refusal = "no face in the left image"});
    see_unusable(0.1, "the left camera gives its last picture again");
  }
  EXPECT_FALSE(watch_.lost(begin_)) << "1.8 s of 3.6 s could be used";
  see_unusable(1, "the left camera gives its last picture again");
  EXPECT_FALSE(watch_.lost(begin_));
}

TEST_F(FaceWatchTest, AFaceThatComesFromWhereNoPatientsAreIsAnotherOne) {
  Parameters parameters;
  parameters.min_patient = {0, -1, 0};
  watch_ = FaceWatch{parameters};
  const auto measure_at = [&](double x, int measurements) {
    see(0.1, true);
    return watch_.see(
        FaceEstimate{.stamp = now_, .mouth = {x, 0, 0.5}, .measurements = measurements});
  };
  for (int k = 1; k <= 10; ++k) measure_at(1, k);
  EXPECT_FALSE(watch_.is_found_anew());
  for (int k = 1; k <= 20; ++k) EXPECT_FALSE(measure_at(-1, k));
  EXPECT_FALSE(watch_.is_found_anew()) << "nothing of that is believed";
  EXPECT_TRUE(measure_at(0.5, 21));
  EXPECT_TRUE(watch_.is_found_anew());
}

TEST_F(FaceWatchTest, BehindAnOutageNoFaceIsSeenBeforeAPictureShowsOne) {
  see(5, true);
  measure(3);
  wait(60);
  see(0.1, false);
  EXPECT_EQ(watch_.disbelief(begin_), "");
}

TEST_F(FaceWatchTest, AFaceThatComesAndGoesIsNotBelievedForTheReasonOfThePictureBefore) {
  see(1, true);
  measure(3);
  for (int k = 0; k < 30; ++k) {
    see(0.1, false);
    watch_.see(Verdict{.stamp = now_, .refusal = "no face in the right image"});
    see(0.1, true);
    measure(3);  // a prediction
  }
  EXPECT_EQ(watch_.disbelief(begin_),
            "a face is seen but not believed: no face in the right image");
  watch_.see(Verdict{.stamp = now_, .refusal = "too little of the right eye is seen"});
  see(0.1, false);
  watch_.see(Verdict{.stamp = now_, .refusal = "no face in the right image"});
  EXPECT_EQ(watch_.disbelief(begin_),
            "a face is seen but not believed: too little of the right eye is seen");
}

TEST_F(FaceWatchTest, ARefusalOfAPictureWithoutAFaceIsNone) {
  see(0.1, false);
  watch_.see_no_estimate("no face in the picture");
  EXPECT_EQ(watch_.refusal(), "");
  EXPECT_EQ(watch_.no_estimate(), "no face in the picture");
}

}  // namespace
}  // namespace armature::task::lamp_alignment
