// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/unit.hpp"

#include <fmt/format.h>

#include <utility>

#include "armature/runtime/exception_text.hpp"

namespace armature {

Unit::Unit(std::string name, std::string plugin_id, int place, Voice::Sink sink)
    : name_{std::move(name)},
      plugin_id_{std::move(plugin_id)},
      place_{place},
      inbox_{[this] {
        if (triggered_) triggered_();
      }},
      voice_{std::make_shared<Voice>(name_, std::move(sink))} {}

void Unit::activate(Time now) {
  if (faulted()) return;
  inbox_.show(now);
  activations_.fetch_add(1, std::memory_order_relaxed);
  try {
    component_->step(now);
    if (component_->finished()) finished_.store(true, std::memory_order_release);
  } catch (...) {
    fault("step", current_exception_text());
  }
}

void Unit::stop(Time now) {
  if (!component_ || faulted()) return;
  try {
    component_->stop(now);
  } catch (...) {
    fault("stop", current_exception_text());
  }
}

void Unit::summarize(Summary& summary) {
  try {
    component_->summarize(summary);
  } catch (...) {
    fault("summarize", current_exception_text());
  }
}

void Unit::fault(std::string_view when, const std::string& what) {
  voice_->set(Voice::State::fault, fmt::format("{} failed: {}", when, what));
  faulted_.store(true, std::memory_order_release);
}

}  // namespace armature
