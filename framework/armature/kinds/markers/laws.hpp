// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <ostream>
#include <span>
#include <string>

#include "armature/kinds/markers/markers.hpp"
#include "armature/laws/law.hpp"

// The laws that every `markers` plugin keeps.
namespace armature ARMATURE_EXPORT {

struct MarkerSubject {
  std::string name;
  std::shared_ptr<const MarkerFinder> finder;

  friend void PrintTo(const MarkerSubject& subject, std::ostream* out) { *out << subject.name; }
};

std::span<const Law<MarkerSubject>> marker_laws();

}  // namespace armature

// The laws by name: LAW(TheSentence, the_function, "in short").
#define ARMATURE_MARKER_LAWS(LAW)                                                                \
  LAW(FindsEveryCentreToATenthOfAVoxel, finds_every_centre,                                      \
      "centres are found to a tenth of a voxel")                                                 \
  LAW(SaysHowFarOffACentreMayBe, says_how_far_off, "sigma and confidence are true")              \
  LAW(FindsNoneWhereThereIsNone, finds_none, "a head without markers has none")                  \
  LAW(TakesNothingElseForAMarker, takes_nothing_else, "bone, needles and larger balls are none") \
  LAW(AMarkerThatIsMissingIsMissing, misses_the_missing, "a marker that is gone is not found")   \
  LAW(FollowsTheImagesFrame, follows_the_frame, "turned and mirrored images turn the markers")   \
  LAW(GivesTheSameBitsForTheSameVolume, repeats_bits, "equal volumes give equal bits")           \
  LAW(RefusesWhatIsNoVolume, refuses_no_volume, "what is no volume is refused")
