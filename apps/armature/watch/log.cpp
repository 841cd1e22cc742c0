// SPDX-License-Identifier: Apache-2.0
#include "watch/log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "armature/config/problems.hpp"
#include "armature/messages/rcl_interfaces.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/values/json_text.hpp"
#include "armature/values/monotonic_now.hpp"
#include "colour.hpp"
#include "date_text.hpp"
#include "exit_code.hpp"
#include "standard_output.hpp"
#include "terminal_text.hpp"

namespace armature {
namespace {

struct Level {
  std::string_view name;
  int least;
};
constexpr std::array<Level, 5> kLevels{
    {{"debug", 10}, {"info", 20}, {"warning", 30}, {"error", 40}, {"fatal", 50}}};

std::string_view name_of(int level) {
  const auto above =
      std::ranges::find_if(kLevels, [&](const Level& one) { return one.least > level; });
  return above == kLevels.begin() ? kLevels.front().name : std::prev(above)->name;
}

int level_named(std::string_view name) {
  return std::ranges::find(kLevels, name, &Level::name)->least;
}

/// Local time of day; of a simulated clock, which starts at 0, its seconds.
std::string time_text(Time time) {
  constexpr std::int64_t kSecond = 1'000'000'000, kYear = 366 * 86400 * kSecond;
  if (time.ns < kYear) return fmt::format("{:12.3f}", 1e-9 * static_cast<double>(time.ns));
  const std::time_t whole = time.ns / kSecond;
  std::tm local{};
  localtime_r(&whole, &local);
  return fmt::format("{}.{:03}", date_text(local, "%H:%M:%S"), time.ns % kSecond / 1'000'000);
}

/// A line, and who has written it.
struct WrittenLine {
  msg::Log log;
  std::string stranger = {};  // whoever says it in a name that is not his deployment's; else ""
};

WrittenLine written(const msg::Log& log, const ObservedEndpoint* writer) {
  const std::string& name = log.name_();
  const bool own =
      !writer || (!writer->deployment.empty() &&
                  (name == writer->deployment || name.starts_with(writer->deployment + ".")));
  return {.log = log, .stranger = own ? "" : writer->owner};
}

void print(const WrittenLine& written, bool json) {
  const msg::Log& line = written.log;
  const Time at = stamp_of(line.stamp_());
  const std::string_view level = name_of(line.level_());
  if (json) {
    nlohmann::ordered_json told{
        {"stamp_ns", at.ns}, {"level", level}, {"name", line.name_()}, {"text", line.msg_()}};
    if (!written.stranger.empty()) told["writer"] = written.stranger;
    return tell(json_text(told));
  }
  std::string text = fmt::format("{} {:<7} {}", time_text(at), level, terminal_text(line.name_()));
  if (!written.stranger.empty()) text += " of " + terminal_text(written.stranger);
  text += ": ";
  constexpr std::size_t kIndent = 21;  // behind time and level
  text += terminal_lines(line.msg_(), kIndent);
  if (line.level_() < level_named("warning")) return tell(text);
  tell(coloured(text, line.level_() < level_named("error") ? Tone::doubtful : Tone::bad,
                standard_output()));
}

/// The lines that are wanted. What was said before comes from several processes, each in its own
/// order: they are kept until all have come, and told by their stamps.
class Lines {
 public:
  explicit Lines(const LogOptions& options) : options_{options} {}

  void add(const WrittenLine& written) {
    const msg::Log& line = written.log;
    const bool wanted = line.level_() >= level_named(options_.level) &&
                        (options_.component.empty() || line.name_() == options_.component ||
                         line.name_().ends_with("." + options_.component));
    if (!wanted) return;
    const std::scoped_lock lock{mutex_};
    if (keeps_) {
      kept_.push_back(written);
    } else {
      print(written, options_.json);
    }
  }
  /// How many have been printed.
  std::size_t told() {
    const std::scoped_lock lock{mutex_};
    return told_;
  }
  void tell_kept() {
    const std::scoped_lock lock{mutex_};
    keeps_ = false;
    std::ranges::stable_sort(kept_, {},
                             [](const WrittenLine& line) { return stamp_of(line.log.stamp_()); });
    for (const WrittenLine& line : kept_) print(line, options_.json);
    told_ += kept_.size();
    kept_.clear();
  }

 private:
  const LogOptions& options_;
  std::mutex mutex_;
  bool keeps_ = true;
  std::size_t told_ = 0;
  std::vector<WrittenLine> kept_;
};

}  // namespace

int print_log(const LogOptions& options) {
  leave_in_order();
  const Time start = monotonic_now();
  Lines lines{options};
  Outsider outsider{options};  // goes before what its callback uses
  const int watching = outsider.watch("/rosout", [&](const ObservedSample& sample) {
    if (const auto line = decoded<msg::Log>(sample)) lines.add(written(*line, sample.writer));
  });
  if (watching != kOk || left()) return watching;
  wait_for(kDiscovery);
  lines.tell_kept();
  const auto is_over = [&] {
    return options.timeout_s > 0 && monotonic_now() - start > seconds(options.timeout_s);
  };
  while (options.follow && !is_over() && wait_for(seconds(0.05))) continue;
  if (!options.follow && !left() && lines.told() == 0) {
    fmt::print(stderr, "armature: nothing was told lately{}\n",
               options.component.empty() ? "" : " by " + config::in_quotes(options.component));
  }
  return kOk;
}

}  // namespace armature
