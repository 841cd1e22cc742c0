// SPDX-License-Identifier: Apache-2.0
#include "replay/repetition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <utility>

#include "armature/messages/known_types.hpp"
#include "terminal_text.hpp"

namespace armature {
namespace {

std::string_view call_name(std::uint8_t call) {
  constexpr std::array<std::string_view, 3> kNames{"step", "begin_stop", "stop"};
  return call < kNames.size() ? kNames[call] : "?";
}

/// Names the difference of an output whose bytes are not those that were recorded.
Repetition::Otherwise other_message(const ReplayedMessage& message,
                                    std::span<const std::byte> recorded) {
  const TypeDescription* type = describe_type(message.type->dds_name);
  auto field = type ? first_difference(*type, recorded, message.cdr) : std::nullopt;
  if (!field) return {.topic = message.topic, .text = "other bytes of equal values"};
  std::string text =
      fmt::format("{}: recorded {}, replayed {}", field->field, field->recorded, field->replayed);
  if (field->ulps) text += fmt::format(", {} ULP apart", with_commas(*field->ulps));
  return {.topic = message.topic, .text = std::move(text), .field = std::move(field)};
}

}  // namespace

std::string with_commas(std::uint64_t number) {
  const std::string digits = std::to_string(number);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
    text += digits[i];
  }
  return text;
}

std::string failure_text(const std::string& failure) {
  return failure.empty() ? "it does not fail" : "'" + terminal_text(failure) + "'";
}

void Repetition::hold(const msg::Activation& call, double at_s, std::uint64_t activation,
                      const ReplayedComponent& component, const RecordedRun& run) {
  std::optional<Otherwise> other = other_output(call, component, run);
  const std::string failure = component.failure().value_or("");
  if (!other && failure != call.failure_()) {
    other = {.text = fmt::format("recorded {}, replayed {}", failure_text(call.failure_()),
                                 failure_text(failure))};
  }
  if (!other || otherwise_) return;
  otherwise_ = std::move(other);
  otherwise_->activation = activation;
  otherwise_->call = call_name(call.call_());
  otherwise_->at_s = at_s;
}

std::optional<Repetition::Otherwise> Repetition::other_output(const msg::Activation& call,
                                                              const ReplayedComponent& component,
                                                              const RecordedRun& run) {
  const auto& published = component.published();
  const std::size_t common = std::min(published.size(), call.written_().size());
  std::optional<Otherwise> other;
  for (std::size_t i = 0; i < common; ++i) {
    const ReplayedMessage& message = published[i];
    const msg::SampleWritten& written = call.written_()[i];
    if (message.writer != written.writer_()) {
      if (!other) other = {.topic = message.topic, .text = "published where it had not"};
      return other;
    }
    const auto recorded = run.sample(written.writer_(), written.sequence_());
    if (!recorded) {
      ++unrecorded_;
    } else if (std::ranges::equal(*recorded, message.cdr)) {
      ++outputs_;
    } else if (!other && !otherwise_) {
      other = other_message(message, *recorded);
    }
  }
  if (other || published.size() == call.written_().size()) return other;
  return Otherwise{.topic = published.size() > common ? published[common].topic : "",
                   .text = fmt::format("recorded {} messages, replayed {}", call.written_().size(),
                                       published.size())};
}

}  // namespace armature
