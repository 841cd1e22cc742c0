// SPDX-License-Identifier: Apache-2.0
#include "watch/top.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "armature/values/json_text.hpp"
#include "armature/values/monotonic_now.hpp"
#include "exit_code.hpp"
#include "standard_output.hpp"
#include "terminal_text.hpp"
#include "watch/seen_deployments.hpp"
#include "watch/top_screen.hpp"
#include "watch/top_table.hpp"

namespace armature {
namespace {

constexpr const char* kKeys =
    "F1 help  F4 filter  P cpu  T step  L late  D dropped  S state  N name  G graph  I invert  "
    "Z pause  q quit";

std::vector<TopLine> help() {
  std::vector<TopLine> lines;
  for (const char* text :
       {"HZ           activations in a second of the deployment's clock",
        "LATE99       99 of 100 steps began at most this long after they were due",
        "STEP50/99    half of the steps, and 99 of 100, took at most this long",
        "CPU%         share of one processor",
        "MISSED       periods that were passed over since the start",
        "DROPPED      samples lost since the start: by full queues, and between processes",
        "ANSWERS TO   the oldest measurement that a step answered to, and how old it was then", "",
        "F4 or \\ or /  show only what has this in its name, process or plugin; Enter ends, Esc "
        "clears it",
        "P T L D S N  sort by processor, step, lateness, drops, state, name; G: by the graph",
        "I            the other way round", "Z or space   stand still, and go on",
        "arrows, PgUp, PgDn, Home, End   scroll",
        "q or F10     leave; nothing that runs is changed"}) {
    lines.push_back({std::string{"  "} + text, std::nullopt});
  }
  return lines;
}

/// The live table: what is shown, and what the keys do to it.
class LiveTable {
 public:
  explicit LiveTable(SeenDeployments& seen) : seen_{seen} {}

  /// `timeout_s`: 0 for ever.
  int run(double interval_s, double timeout_s) {
    const Time start = monotonic_now();
    Time next;
    while (!left() && !quits_) {
      if (timeout_s > 0 && monotonic_now() - start > seconds(timeout_s)) return kOk;
      const bool due = monotonic_now() >= next;
      if (due) {
        seen_.look();
        if (!stands_) shown_ = seen_.all();
        // What is found at first is not kept back for a long interval.
        const bool is_young = monotonic_now() - start < 2 * kDiscovery;
        next = monotonic_now() + (is_young ? seconds(0.2) : seconds(interval_s));
      }
      const TopScreen::Pressed pressed = screen_.pressed();
      if (pressed.key != TopScreen::Key::none) take(pressed);
      if (due || pressed.key != TopScreen::Key::none) draw();
    }
    return kOk;
  }

 private:
  using Key = TopScreen::Key;

  void draw() {
    TopTable table = top_table(shown_, view_, monotonic_now());
    lines_ = helps_ ? help() : std::move(table.lines);
    if (!helps_) {
      for (const std::string& note : seen_.notes()) {
        lines_.push_back({terminal_text(note), Tone::doubtful});
      }
    }
    if (lines_.empty()) lines_.push_back({"waiting for a deployment that tells how it is", {}});
    const std::size_t last = lines_.size() > screen_.room() ? lines_.size() - screen_.room() : 0;
    first_ = std::min(first_, last);
    const std::string filter = "filter: " + view_.filter;
    screen_.show(table.title, lines_, first_,
                 types_ ? filter + "_" : (view_.filter.empty() ? kKeys : filter + "   " + kKeys));
  }

  void take(const TopScreen::Pressed& pressed) {
    if (types_) return type(pressed);
    const std::size_t page = screen_.room();
    switch (pressed.key) {
      case Key::quit: quits_ = true; return;
      case Key::help: helps_ = !helps_; return;
      case Key::up: first_ -= std::min<std::size_t>(first_, 1); return;
      case Key::down: ++first_; return;
      case Key::page_up: first_ -= std::min(first_, page); return;
      case Key::page_down: first_ += page; return;
      case Key::home: first_ = 0; return;
      case Key::end: first_ = lines_.size(); return;
      case Key::filter:
        view_.filter.clear();
        types_ = true;
        return;
      case Key::other: return take_letter(pressed.letter);
      case Key::none:
      case Key::erase:
      case Key::enter:
      case Key::escape: helps_ = false;
    }
  }

  void take_letter(char letter) {
    switch (letter) {
      case 'P': return sort(TopOrder::processor);
      case 'T': return sort(TopOrder::step);
      case 'L': return sort(TopOrder::lateness);
      case 'D': return sort(TopOrder::dropped);
      case 'S': return sort(TopOrder::state);
      case 'N': return sort(TopOrder::name);
      case 'G': return sort(TopOrder::graph);
      case 'I': view_.reversed = !view_.reversed; return;
      case 'Z':
      case 'z':
      case ' ': stands_ = !stands_; return;
      case 'h':
      case '?': helps_ = !helps_; return;
      default: return;
    }
  }

  void sort(TopOrder order) {
    view_.order = order;
    view_.reversed = false;
  }

  void type(const TopScreen::Pressed& pressed) {
    if (pressed.letter != 0) {
      view_.filter += pressed.letter;
    } else if (pressed.key == Key::quit) {
      quits_ = true;
    } else if (pressed.key == Key::enter || pressed.key == Key::escape) {
      if (pressed.key == Key::escape) view_.filter.clear();
      types_ = false;
    } else if (pressed.key == Key::erase && !view_.filter.empty()) {
      view_.filter.pop_back();
    }
  }

  SeenDeployments& seen_;
  TopScreen screen_;
  TopView view_;
  std::map<std::string, SeenDeployment> shown_;
  std::vector<TopLine> lines_;
  std::size_t first_ = 0;  // line that is shown
  bool quits_ = false, helps_ = false, stands_ = false, types_ = false;
};

/// Says on stderr whom it does not believe, each once.
class ToldNotes {
 public:
  void tell_new(const SeenDeployments& seen) {
    const std::vector<std::string> notes = seen.notes();
    for (; told_ < notes.size(); ++told_) {
      fmt::print(stderr, "armature: {}\n", terminal_text(notes[told_]));
    }
  }

 private:
  std::size_t told_ = 0;
};

/// Waits until a deployment has told how its components are, twice: rates need it.
int meet(SeenDeployments& seen, const TopOptions& options, ToldNotes& notes) {
  const Time start = monotonic_now();
  for (bool told = false; !left();) {
    seen.look();
    notes.tell_new(seen);
    for (const auto& [name, deployment] : seen.all()) {
      const bool twice = std::ranges::any_of(
          deployment.components, [](const auto& one) { return one.second.rate_hz > 0; });
      if (twice && (deployment.is_whole() || monotonic_now() - start > 2 * kDiscovery)) return kOk;
    }
    const Duration waited = monotonic_now() - start;
    if (options.timeout_s > 0 && waited > seconds(options.timeout_s)) {
      fmt::print(stderr, "armature: no deployment {}tells how it is in domain {} within {:g} s\n",
                 options.deployment.empty() ? "" : "'" + options.deployment + "' ",
                 options.network.domain, options.timeout_s);
      return kTimedOut;
    }
    if (!told && options.timeout_s <= 0 && waited > 2 * kDiscovery) {
      told = true;
      fmt::print(stderr,
                 "armature: no deployment tells how it is in domain {} yet, waiting for "
                 "one\n",
                 options.network.domain);
    }
    wait_for(seconds(0.05));
  }
  return kOk;
}

int print_tables(SeenDeployments& seen, const TopOptions& options) {
  const Time start = monotonic_now();
  ToldNotes notes;
  if (const int code = meet(seen, options, notes); code != kOk) return code;
  for (std::uint64_t i = 0; options.count == 0 || i < options.count; ++i) {
    const Duration interval = seconds(i == 0 ? 0 : options.interval_s);
    const Duration rest = seconds(options.timeout_s) - (monotonic_now() - start);
    const bool is_over = i > 0 && options.timeout_s > 0 && rest < interval;
    if (!wait_for(is_over ? rest : interval)) break;
    if (is_over && options.count == 0) break;
    if (is_over) {
      fmt::print(stderr, "armature: {} of {} tables within {:g} s\n", i, options.count,
                 options.timeout_s);
      return kTimedOut;
    }
    seen.look();
    notes.tell_new(seen);
    if (options.json) {
      tell(json_text(top_json(seen.all(), monotonic_now())));
      continue;
    }
    const TopTable table = top_table(seen.all(), {}, monotonic_now());
    tell(table.title);
    for (const auto& [text, tone] : table.lines) {
      tell(tone ? coloured(text, *tone, standard_output()) : text);
    }
  }
  return kOk;
}

}  // namespace

int watch_components(const TopOptions& options) {
  leave_in_order();
  SeenDeployments seen{options, options.deployment};
  const char* term = std::getenv("TERM");
  const bool is_dumb = term && std::string_view{term} == "dumb";
  const bool live = !options.json && options.count == 0 && !is_dumb &&
                    isatty(standard_output_descriptor()) != 0 && isatty(STDIN_FILENO) != 0;
  if (!live) return print_tables(seen, options);
  return LiveTable{seen}.run(options.interval_s, options.timeout_s);
}

}  // namespace armature
