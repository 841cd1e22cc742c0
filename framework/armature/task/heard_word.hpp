// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "armature/messages/armature_msgs.hpp"
#include "armature/task/procedure.hpp"
#include "armature/values/expected.hpp"
#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// How far the stamp of a word may be from now. It is longer than a word is under way between two
/// hosts whose clocks are nearly right, and shorter than a question needs to be read and answered:
/// a word that somebody buffered or recorded answers another question.
inline constexpr Duration kWordHolds = seconds(1.0);

/// An operator's word as it came, its texts cut behind 64 letters, with "..." then: answers quote
/// them.
OperatorCommand heard_word(const msg::OperatorCommand& message);

/// Refuses `confirm`, `resume` and `back` unless their stamp is within `kWordHolds` of `now`. A
/// `pause` and an `abort` make safe, and are in time whatever their stamp; so is a word that is
/// none, which is refused elsewhere.
Expected<void> in_time(const std::string& word, Time stamp, Time now);

}  // namespace armature
