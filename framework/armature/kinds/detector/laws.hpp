// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <ostream>
#include <span>
#include <string>

#include "armature/kinds/detector/detector.hpp"
#include "armature/kinds/face_picture.hpp"
#include "armature/laws/law.hpp"

// The laws that every `detector` plugin keeps.
namespace armature ARMATURE_EXPORT {

/// A detector (made once, when it is needed first), a picture with one face, and a point [px] in
/// the middle of that face. Without a picture (`face` is empty) the laws about it are skipped.
struct DetectorSubject {
  std::string name;
  std::function<FaceDetector&()> detector;
  std::function<Picture()> face;
  double middle_x = 0, middle_y = 0;

  friend void PrintTo(const DetectorSubject& subject, std::ostream* out) { *out << subject.name; }
};

std::span<const Law<DetectorSubject>> detector_laws();

}  // namespace armature

// The laws by name: LAW(TheSentence, the_function, "in short").
#define ARMATURE_DETECTOR_LAWS(LAW)                                                               \
  LAW(FindsTheFaceWhereItIs, finds_face, "the face is found where it is")                         \
  LAW(FindsItAgainInARegionAroundItAndNotInOneAside, finds_in_region,                             \
      "it is found in a region around it, not aside")                                             \
  LAW(APictureWithoutAFaceHasNone, finds_none_without_face, "a picture without a face has none")  \
  LAW(PicturesTooSmallForAFaceHaveNone, finds_none_in_small, "a picture too small has no face")   \
  LAW(EqualPicturesGiveEqualBitsWhateverWasSeenInBetween, repeats_bits,                           \
      "equal pictures give equal bits")                                                           \
  LAW(RowsMayBeLongerThanThePictureIsWide, takes_longer_rows, "rows may be longer than wide")     \
  LAW(ARegionThatIsNoneHasNoFaces, finds_none_in_no_region, "a region that is none has no faces") \
  LAW(RefusesViewsThatAreNoImage, refuses_no_image, "a view that is no image is refused")
