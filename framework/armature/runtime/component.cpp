// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/component.hpp"

#include "armature/runtime/setup.hpp"
#include "armature/runtime/voice.hpp"

namespace armature {

SetupError::~SetupError() = default;
SlotError::~SlotError() = default;

Component::Component(Setup& setup) : voice_{setup.voice()} {}

void Component::say(std::string_view text) { voice_->say(text); }
void Component::degraded(std::string_view reason) { voice_->set(Voice::State::degraded, reason); }
void Component::healthy() { voice_->set(Voice::State::ok, {}); }

}  // namespace armature
