// SPDX-License-Identifier: Apache-2.0
#include "watch/top_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "terminal_text.hpp"

namespace armature {
namespace {

using Json = nlohmann::ordered_json;

constexpr Duration kSilent = seconds(3);  // states come twice a second
constexpr std::size_t kUnplaced = 1'000'000;

/// A component as a row of the table.
struct Row {
  std::string process;
  const SeenComponent* component;
  std::size_t place = kUnplaced;  // in the graph
  std::string state, reason;
  std::optional<Tone> tone;
  bool is_silent = false;
  double rate_hz = 0, processor = 0;

  const msg::ComponentState& told() const { return component->state; }
};

/// The path from a measurement to this component that takes longest.
const msg::ReactionTiming* slowest(const msg::ComponentState& state) {
  const auto& reactions = state.reactions_();
  const auto found = std::ranges::max_element(
      reactions, {}, [](const msg::ReactionTiming& reaction) { return reaction.age_().p99_(); });
  return found == reactions.end() ? nullptr : &*found;
}

Row row_of(const std::string& process, const SeenComponent& component, Time now) {
  constexpr std::array<std::string_view, 4> kStates{"ok", "degraded", "fault", "stalled"};
  Row row{.process = process,
          .component = &component,
          .rate_hz = component.rate_hz,
          .processor = component.processor};
  const std::size_t state = component.state.state_();
  row.state = state < kStates.size() ? kStates[state] : fmt::format("state {}", state);
  row.reason = component.state.reason_();
  if (state > 0) row.tone = state == 1 ? Tone::doubtful : Tone::bad;
  if (now - component.heard > kSilent) {
    row.is_silent = true;
    row.state = "silent";
    row.reason = fmt::format("has told nothing for {:.0f} s", to_seconds(now - component.heard));
    row.tone = Tone::bad;
    row.rate_hz = row.processor = 0;
  }
  return row;
}

std::vector<Row> rows_of(const SeenDeployment& deployment, Time now) {
  std::map<std::pair<std::string, std::string>, std::size_t> places;
  for (const auto& [process, description] : deployment.processes) {
    for (const auto& component : description.components_()) {
      places.emplace(std::pair{process, component.name_()}, places.size());
    }
  }
  std::vector<Row> rows;
  for (const auto& [name, component] : deployment.components) {
    rows.push_back(row_of(name.first, component, now));
    const auto place = places.find(name);
    if (place != places.end()) rows.back().place = place->second;
  }
  std::ranges::stable_sort(rows, {}, &Row::place);
  return rows;
}

/// Before what it is compared with: greatest figures first, worst states first.
bool is_before(const Row& a, const Row& b, TopOrder order) {
  const msg::ComponentState &left = a.told(), &right = b.told();
  switch (order) {
    case TopOrder::graph: return a.place < b.place;
    case TopOrder::name: return left.component_() < right.component_();
    case TopOrder::state: return left.state_() > right.state_();
    case TopOrder::processor: return a.processor > b.processor;
    case TopOrder::step: return left.step_().p99_() > right.step_().p99_();
    case TopOrder::lateness: return left.lateness_().p99_() > right.lateness_().p99_();
    case TopOrder::dropped: return left.dropped_() > right.dropped_();
  }
  return false;
}

/// In three digits: "87 us", "1.25 ms", "2.3 s"; "-" for none.
std::string time_text(double time_s) {
  if (time_s <= 0) return "-";
  if (time_s < 1e-3) return fmt::format("{:.3g} us", time_s * 1e6);
  if (time_s < 1) return fmt::format("{:.3g} ms", time_s * 1e3);
  return fmt::format("{:.3g} s", time_s);
}

std::string reaction_text(const msg::ReactionTiming* reaction) {
  if (!reaction) return "-";
  return fmt::format("{} {} {}", reaction->source_(), time_text(reaction->age_().p50_()),
                     time_text(reaction->age_().p99_()));
}

constexpr const char* kRow = "  {:<{}} {:<{}} {:<8} {:>7} {:>8} {:>8} {:>8} {:>5} {:>6} {:>7}  {}";

/// How wide the names are.
struct Widths {
  std::size_t component = std::string_view{"COMPONENT"}.size();
  std::size_t process = std::string_view{"PROCESS"}.size();
};

std::string text_of(const Row& row, const Widths& widths) {
  const msg::ComponentState& told = row.told();
  return fmt::format(fmt::runtime(kRow), told.component_(), widths.component, row.process,
                     widths.process, row.state, fmt::format("{:.1f}", row.rate_hz),
                     time_text(told.lateness_().p99_()), time_text(told.step_().p50_()),
                     time_text(told.step_().p99_()), fmt::format("{:.1f}", 100 * row.processor),
                     told.overruns_(), told.dropped_(), reaction_text(slowest(told)));
}

bool passes(const Row& row, const std::string& filter) {
  const auto contains = [&](const std::string& text) {
    return text.find(filter) != std::string::npos;
  };
  const msg::ComponentState& told = row.told();
  return contains(told.component_()) || contains(row.process) || contains(told.plugin_());
}

TopLine summary_of(const std::string& name, const SeenDeployment& deployment,
                   const std::vector<Row>& rows) {
  const auto well =
      std::ranges::count_if(rows, [](const Row& row) { return !row.tone.has_value(); });
  std::size_t described = 0;
  for (const auto& [process, told] : deployment.processes) described += told.components_().size();
  const std::size_t all = std::max(described, rows.size());
  std::string text = fmt::format("{}: {} of {} components ok", name, well, all);
  if (deployment.processes.empty()) return {text, std::nullopt};
  const msg::DeploymentDescription& told = deployment.processes.begin()->second;
  text += fmt::format(", {} of {} processes, {} clock, fingerprint {}", deployment.processes.size(),
                      told.processes_().size(), told.simulated_() ? "simulated" : "system",
                      told.fingerprint_().substr(0, 12));
  std::vector<std::string> missing = deployment.missing();
  for (const Row& row : rows) {
    const bool is_new = std::ranges::find(missing, row.process) == missing.end();
    if (row.is_silent && is_new) missing.push_back(row.process);
  }
  if (all > rows.size()) text += fmt::format("; {} have told nothing yet", all - rows.size());
  if (missing.empty()) {
    return {text, all > rows.size() ? std::optional{Tone::doubtful} : std::nullopt};
  }
  return {text + fmt::format("; nothing is heard of process '{}'", fmt::join(missing, "', '")),
          Tone::bad};
}

Json json_of(const msg::StepTiming& timing) {
  return {{"last", timing.last_()},
          {"mean", timing.mean_()},
          {"p50", timing.p50_()},
          {"p99", timing.p99_()},
          {"max", timing.max_()}};
}

Json json_of(const Row& row) {
  const msg::ComponentState& told = row.told();
  Json json{{"component", told.component_()},
            {"process", row.process},
            {"plugin", told.plugin_()},
            {"state", row.state},
            {"reason", row.reason},
            {"rate_hz", row.rate_hz},
            {"processor", row.processor},
            {"activations", told.activations_()},
            {"missed", told.overruns_()},
            {"dropped", told.dropped_()},
            {"lateness_s", json_of(told.lateness_())},
            {"step_s", json_of(told.step_())},
            {"reactions", Json::array()}};
  for (const msg::ReactionTiming& reaction : told.reactions_()) {
    json["reactions"].push_back({{"to", reaction.source_()},
                                 {"count", reaction.count_()},
                                 {"age_s", json_of(reaction.age_())}});
  }
  return json;
}

}  // namespace

TopTable top_table(const std::map<std::string, SeenDeployment>& seen, const TopView& view,
                   Time now) {
  Widths widths;
  for (const auto& [name, deployment] : seen) {
    for (const auto& [place, component] : deployment.components) {
      widths.process = std::max(widths.process, place.first.size());
      widths.component = std::max(widths.component, place.second.size());
    }
  }
  TopTable table{.title = fmt::format(fmt::runtime(kRow), "COMPONENT", widths.component, "PROCESS",
                                      widths.process, "STATE", "HZ", "LATE99", "STEP50", "STEP99",
                                      "CPU%", "MISSED", "DROPPED", "ANSWERS TO, P50, P99")};
  for (const auto& [name, deployment] : seen) {
    std::vector<Row> rows = rows_of(deployment, now);
    table.lines.push_back(summary_of(name, deployment, rows));
    std::ranges::stable_sort(
        rows, [&](const Row& a, const Row& b) { return is_before(a, b, view.order); });
    if (view.reversed) std::ranges::reverse(rows);
    for (const Row& row : rows) {
      if (!passes(row, view.filter)) continue;
      table.lines.push_back({text_of(row, widths), row.tone});
      if (!row.reason.empty()) table.lines.push_back({"      " + row.reason, row.tone});
    }
  }
  // Names and reasons are what others wrote, who need not be a deployment.
  for (TopLine& line : table.lines) line.text = terminal_text(line.text);
  return table;
}

Json top_json(const std::map<std::string, SeenDeployment>& seen, Time now) {
  Json json = Json::array();
  for (const auto& [name, deployment] : seen) {
    json.push_back({{"deployment", name}});
    if (!deployment.processes.empty()) {
      const msg::DeploymentDescription& told = deployment.processes.begin()->second;
      json.back()["run"] = told.run_();
      json.back()["fingerprint"] = told.fingerprint_();
      json.back()["simulated"] = told.simulated_();
    }
    json.back()["components"] = Json::array();
    for (const Row& row : rows_of(deployment, now)) {
      json.back()["components"].push_back(json_of(row));
    }
  }
  return json;
}

}  // namespace armature
