// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/component/component.hpp"

#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/component/voice.hpp"

namespace armature {

Component::Component(Setup& setup) : voice_{setup.voice()} {}

void Component::say(std::string_view text) { voice_->say(text); }
void Component::degraded(std::string_view reason) { voice_->set(Voice::State::degraded, reason); }
void Component::healthy() { voice_->set(Voice::State::ok, {}); }

}  // namespace armature
