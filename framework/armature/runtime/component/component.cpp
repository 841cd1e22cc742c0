// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/component/component.hpp"

#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/component/status_reporter.hpp"

namespace armature {

Component::Component(Setup& setup) : reporter_{setup.reporter()} {}

void Component::log(std::string_view text) { reporter_->log(text); }
void Component::degraded(std::string_view reason) {
  reporter_->set(StatusReporter::State::degraded, reason);
}
void Component::healthy() { reporter_->set(StatusReporter::State::ok, {}); }

}  // namespace armature
