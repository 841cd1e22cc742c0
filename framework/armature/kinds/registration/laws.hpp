// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <ostream>
#include <span>
#include <string>

#include "armature/kinds/registration/registration.hpp"
#include "armature/laws/law.hpp"

// The laws that every `registration` plugin keeps.
namespace armature ARMATURE_EXPORT {

struct RegistrationSubject {
  std::string name;
  std::shared_ptr<const Registrar> registrar;
  std::size_t least;  // number of markers that it needs

  friend void PrintTo(const RegistrationSubject& subject, std::ostream* out) {
    *out << subject.name;
  }
};

std::span<const Law<RegistrationSubject>> registration_laws();

}  // namespace armature

// The laws by name: LAW(TheSentence, the_function, "in short").
#define ARMATURE_REGISTRATION_LAWS(LAW)                                                       \
  LAW(FindsTheMotionThatMovedTheMarkersWithoutError, finds_the_motion,                        \
      "exact markers give the motion")                                                        \
  LAW(TellsEveryResidualAndTheirMeanSquareOverTheMarkersUsed, tells_residuals,                \
      "residuals and FRE are true")                                                           \
  LAW(DoesNotDependOnWhereTheFramesStand, independent_of_frames, "frames may stand anywhere") \
  LAW(TheErrorAtATargetIsAsPredicted, target_error_as_predicted,                              \
      "the error at a target is as predicted")                                                \
  LAW(AMarkerThatIsWrongIsFoundOrStandsInTheBound, one_wrong,                                 \
      "a wrong marker is found or in the bound")                                              \
  LAW(GivesTheSameBitsForTheSameMarkers, same_bits, "equal markers give equal bits")          \
  LAW(RefusesMarkersThatDetermineNothingAndGoesOn, refuses_useless, "useless markers are refused")
