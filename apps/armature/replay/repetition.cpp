// SPDX-License-Identifier: Apache-2.0
#include "replay/repetition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

#include "armature/messages/known_types.hpp"
#include "replay/message_difference.hpp"
#include "terminal_text.hpp"

namespace armature {
namespace {

/// Of an output whose bytes are not those that were recorded.
std::string first_difference_of(const ReplayedMessage& message,
                                std::span<const std::byte> recorded) {
  const TypeDescription* type = describe_type(message.type->dds_name);
  const auto field = type ? first_difference(*type, recorded, message.cdr) : std::nullopt;
  if (!field) return "other bytes of equal values";
  return fmt::format("{}: recorded {}, repeated {}", field->field, field->recorded,
                     field->replayed);
}

}  // namespace

std::string failure_text(const std::string& failure) {
  return failure.empty() ? "it does not fail" : "'" + terminal_text(failure) + "'";
}

void Repetition::hold(const msg::Activation& call, double at_s, const ReplayedComponent& component,
                      const RecordedRun& run) {
  hold_outputs(call, at_s, component, run);
  const std::string failure = component.failure().value_or("");
  if (failure == call.failure_()) return;
  note(at_s, "",
       fmt::format("recorded {}, repeated {}", failure_text(call.failure_()),
                   failure_text(failure)));
}

void Repetition::hold_outputs(const msg::Activation& call, double at_s,
                              const ReplayedComponent& component, const RecordedRun& run) {
  const auto& published = component.published();
  const std::size_t common = std::min(published.size(), call.written_().size());
  for (std::size_t i = 0; i < common; ++i) {
    const ReplayedMessage& message = published[i];
    const msg::SampleWritten& written = call.written_()[i];
    if (message.writer != written.writer_()) {
      return note(at_s, message.topic, "published where it had not");
    }
    const auto recorded = run.sample(written.writer_(), written.sequence_());
    if (!recorded) {
      ++unrecorded_;
    } else if (!std::ranges::equal(*recorded, message.cdr) && !otherwise_) {
      note(at_s, message.topic, first_difference_of(message, *recorded));
    }
  }
  if (published.size() == call.written_().size()) return;
  note(at_s, published.size() > common ? published[common].topic : "",
       fmt::format("recorded {} messages, repeated {}", call.written_().size(), published.size()));
}

void Repetition::note(double at_s, const std::string& topic, std::string text) {
  if (otherwise_) return;
  otherwise_ = {.at_s = at_s, .topic = topic, .text = std::move(text)};
}

}  // namespace armature
