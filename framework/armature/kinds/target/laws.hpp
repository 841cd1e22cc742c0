// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <ostream>
#include <span>
#include <string>

#include "armature/kinds/target/target.hpp"
#include "armature/laws/law.hpp"

// The laws that every `target` plugin keeps.
namespace armature ARMATURE_EXPORT {

struct TargetSubject {
  std::string name;
  std::shared_ptr<const TargetFilter> filter;

  friend void PrintTo(const TargetSubject& subject, std::ostream* out) { *out << subject.name; }
};

std::span<const Law<TargetSubject>> target_laws();

}  // namespace armature

// The laws by name: LAW(TheSentence, the_function, "in short").
#define ARMATURE_TARGET_LAWS(LAW)                                                                  \
  LAW(StartsWithTheFirstMeasurement, starts_with_first, "the first look is the estimate")          \
  LAW(KeepsTheNormalAUnitVectorAndItsRateAcross, normal_is_unit, "the normal is a unit vector")    \
  LAW(PredictsFromTheEstimateWithoutAJump, predicts_without_jump,                                  \
      "predictions begin without a jump")                                                          \
  LAW(RemembersNothingBesidesTheState, remembers_only_state, "it remembers nothing but its state") \
  LAW(RefusesBadMeasurementsAndKeepsItsState, refuses_bad, "bad looks are refused")                \
  LAW(TakesAStateOfAnotherPluginForNone, foreign_state_is_none, "a state of another is none")
