// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <mutex>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "armature/messages/cdr_reader.hpp"
#include "armature/messages/known_types.hpp"
#include "armature/runtime/execution/clock.hpp"
#include "armature/values/json_text.hpp"
#include "armature/values/monotonic_now.hpp"
#include "exit_code.hpp"
#include "watch/sample_count.hpp"
#include "watch/topic_meter.hpp"
#include "watch/topics.hpp"

namespace armature {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kAnotherClock_s = 86400;

/// From the stamp of a sample's header to now. Throws where there is none, and where it is not by
/// the clock of this machine.
double delay_of(const ObservedSample& sample, const std::string& topic) {
  const TypeDescription* type = describe_type(sample.type);
  const bool has_header = type && !type->fields.empty() && type->fields.front().structure &&
                          type->fields.front().structure->ros_name == "std_msgs/Header";
  if (!has_header) {
    throw std::runtime_error(
        fmt::format("'{}' is a {}, which begins with no header: there is no "
                    "stamp to measure a delay from",
                    topic, type ? type->ros_name : sample.type));
  }
  CdrReader reader{sample.cdr};
  const std::int64_t sec = reader.number<std::int32_t>();
  const auto nanosec = reader.number<std::uint32_t>();
  if (!reader.ok()) {
    throw std::runtime_error(fmt::format("'{}' sent what is no {}", topic, type->ros_name));
  }
  const double delay_s = to_seconds(SystemClock{}.now() - Time{sec * 1'000'000'000 + nanosec});
  if (std::abs(delay_s) < kAnotherClock_s) return delay_s;
  throw std::runtime_error(
      fmt::format("'{}' is stamped {:.0f} days from this machine's clock: by a simulated one, or "
                  "not at all; what is late in a deployment is told by: armature top",
                  topic, std::abs(delay_s) / kAnotherClock_s));
}

void describe(const TopicFigures& figures, TopicMeasure what, const char* of_all, std::string& text,
              Json& json) {
  const auto samples = static_cast<double>(figures.samples);
  switch (what) {
    case TopicMeasure::rate:
      text = fmt::format("{:.1f} Hz over {} samples{}, intervals from {:.2f} to {:.2f} ms",
                         figures.hz(), figures.samples, of_all, figures.interval_s.least * 1e3,
                         figures.interval_s.greatest * 1e3);
      json["rate_hz"] = figures.hz();
      json["shortest_s"] = figures.interval_s.least;
      json["longest_s"] = figures.interval_s.greatest;
      return;
    case TopicMeasure::bandwidth:
      text = fmt::format("{:.3f} MB/s over {} samples{}, of {} to {} bytes",
                         figures.bytes_per_s() * 1e-6, figures.samples, of_all, figures.bytes.least,
                         figures.bytes.greatest);
      json["bytes_s"] = figures.bytes_per_s();
      json["smallest"] = figures.bytes.least;
      json["largest"] = figures.bytes.greatest;
      return;
    case TopicMeasure::delay:
      text = fmt::format("{:.2f} ms over {} samples{}, from {:.2f} to {:.2f} ms",
                         figures.delay_s.sum / samples * 1e3, figures.samples, of_all,
                         figures.delay_s.least * 1e3, figures.delay_s.greatest * 1e3);
      json["mean_s"] = figures.delay_s.sum / samples;
      json["shortest_s"] = figures.delay_s.least;
      json["longest_s"] = figures.delay_s.greatest;
      return;
  }
}

/// How many samples there must be before there is something to tell.
std::uint64_t min_samples_of(TopicMeasure what) { return what == TopicMeasure::delay ? 1 : 2; }

/// One line; `over` is "second" or "all".
void print(const TopicFigures& figures, TopicMeasure what, std::string_view over, bool json) {
  const bool all = over == "all";
  const bool enough = figures.samples > 0 && (min_samples_of(what) < 2 || figures.intervals > 0);
  std::string text = "no samples";
  Json line{{"over", over}, {"samples", figures.samples}};
  if (enough) describe(figures, what, all ? " in all" : "", text, line);
  if (figures.lost > 0) text += fmt::format(", {} lost", figures.lost);
  line["lost"] = figures.lost;
  tell(json ? json_text(line) : text);
}

}  // namespace

int measure_topic(TopicMeasure what, const TopicOptions& options) {
  leave_in_order();
  SampleCount count{options, min_samples_of(what)};
  std::mutex mutex;
  TopicMeter meter;
  std::string wrong;
  Outsider outsider{options, !options.best_effort};  // goes before what its callback uses
  const int watching = outsider.watch(options.topic, [&](const ObservedSample& sample) {
    const std::scoped_lock lock{mutex};
    if (count.full()) return;
    try {
      const bool delay = what == TopicMeasure::delay;
      meter.add({.source = sample.source,
                 .bytes = sample.cdr.size(),
                 .delay_s = delay ? delay_of(sample, options.topic) : 0,
                 .lost_before = sample.lost_before,
                 .writer = sample.writer ? sample.writer->guid : std::array<std::uint8_t, 16>{},
                 .arrived = monotonic_now()});
      count.add();
    } catch (const std::runtime_error& error) {
      wrong = error.what();
      count.end();
    }
  });
  if (watching != kOk) return watching;
  const int code = count.wait([&] {
    const std::scoped_lock lock{mutex};
    if (meter.all().samples > 0) print(meter.take_recent(), what, "second", options.json);
  });
  const std::scoped_lock lock{mutex};
  if (!wrong.empty()) throw std::runtime_error(wrong);
  if (meter.all().samples < min_samples_of(what)) {
    if (code != kOk) return code;
    throw std::runtime_error(fmt::format("interrupted before {} of '{}' came",
                                         min_samples_of(what) < 2 ? "a sample" : "two samples",
                                         options.topic));
  }
  print(meter.all(), what, "all", options.json);
  return code;
}

}  // namespace armature
