// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/ik/contract/law.hpp"

#include <fmt/format.h>

#include <array>
#include <exception>

#include "armature/kinds/ik/contract/laws.hpp"
#include "armature/kinds/ik/contract/probe.hpp"

namespace armature {

#define ARMATURE_IK_LAW_ENTRY(Name, function, says) IkLaw{#Name, says, &ik_contract::function},
std::span<const IkLaw> ik_laws() {
  static constexpr std::array kLaws{ARMATURE_IK_LAWS(ARMATURE_IK_LAW_ENTRY)};
  return kLaws;
}
#undef ARMATURE_IK_LAW_ENTRY

LawReport check_law(const IkLaw& law, const IkSubject& subject, const IkLawTools& tools) {
  ik_contract::Probe probe{subject, tools};
  try {
    law.check(probe);
  } catch (const std::exception& error) {
    probe.violated(fmt::format("the solver throws: {}", error.what()));
  } catch (...) {
    probe.violated("the solver throws what is no std::exception");
  }
  return probe.report();
}

}  // namespace armature
