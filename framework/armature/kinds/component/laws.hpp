// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <ostream>
#include <span>
#include <string>

#include "armature/laws/law.hpp"
#include "armature/runtime/testing/component_harness.hpp"

// The laws that every component keeps, whatever it does: with its ports in memory only, activated
// by hand, as fast as it goes.
namespace armature ARMATURE_EXPORT {

struct ComponentSubject {
  std::string name;
  /// Makes it anew. Throws what it throws; a component that claims other ports than those of its
  /// plugin.yaml is thrown as std::logic_error.
  std::function<std::unique_ptr<ComponentHarness>()> make;
  std::uint64_t seed = 1;  // of messages made by chance
  int rounds = 300;        // activations with such messages

  friend void PrintTo(const ComponentSubject& subject, std::ostream* out) { *out << subject.name; }
};

std::span<const Law<ComponentSubject>> component_laws();

}  // namespace armature

// The laws by name: LAW(TheSentence, the_function, "in short").
#define ARMATURE_COMPONENT_LAWS(LAW)                                                       \
  LAW(ClaimsThePortsOfItsPluginYaml, claims_ports, "its ports are those of plugin.yaml")   \
  LAW(SilenceIsNoFault, silence, "silence is no fault")                                    \
  LAW(EmptyMessagesAreNoFault, empty_messages, "empty messages are no fault")              \
  LAW(NumbersThatAreNoneAreNoFault, nan_messages, "messages full of NaN are no fault")     \
  LAW(MessagesByChanceAreNoFault, random_messages, "messages made by chance are no fault") \
  LAW(AStopIsAnsweredWithRest, stop_is_answered, "a stop request is answered within 3 s")  \
  LAW(IsMadeAgainAfterItEnded, made_again, "it is made again after it ended")
