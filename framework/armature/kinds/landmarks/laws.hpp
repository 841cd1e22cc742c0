// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <ostream>
#include <span>
#include <string>

#include "armature/kinds/face_picture.hpp"
#include "armature/kinds/landmarks/landmarks.hpp"
#include "armature/laws/law.hpp"

// The laws that every `landmarks` plugin keeps.
namespace armature ARMATURE_EXPORT {

/// A finder (made once, when it is needed first), a picture with a face, and where the face is.
/// Without a picture (`face` is empty) the laws about it are skipped.
struct LandmarkSubject {
  std::string name;
  std::function<LandmarkFinder&()> finder;
  std::function<Picture()> face;
  PixelBox box;

  friend void PrintTo(const LandmarkSubject& subject, std::ostream* out) { *out << subject.name; }
};

std::span<const Law<LandmarkSubject>> landmark_laws();

}  // namespace armature

// The laws by name: LAW(TheSentence, the_function, "in short").
#define ARMATURE_LANDMARK_LAWS(LAW)                                                           \
  LAW(FindsAsManyLandmarksAsItsSchemeHasNearTheBox, finds_near_box,                           \
      "as many landmarks as its scheme, near the box")                                        \
  LAW(TellsLeftEyeRightEyeAndMouthOfAnUprightFaceApart, tells_features_apart,                 \
      "left eye, right eye and mouth are in place")                                           \
  LAW(EqualPicturesGiveEqualBitsWhateverWasSeenInBetween, repeats_bits,                       \
      "equal pictures give equal bits")                                                       \
  LAW(RowsMayBeLongerThanThePictureIsWide, takes_longer_rows, "rows may be longer than wide") \
  LAW(ABoxThatLiesElsewhereIsAnsweredWithFiniteLandmarksOrARefusal, answers_any_box,          \
      "any box: finite landmarks or a refusal")                                               \
  LAW(RefusesViewsThatAreNoImage, refuses_no_image, "a view that is no image is refused")
