// SPDX-License-Identifier: Apache-2.0
#include "operator/procedure_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "armature/task/procedure.hpp"
#include "terminal_text.hpp"

namespace armature {
namespace {

std::string_view name_of(const msg::TaskStep& step) {
  switch (static_cast<Procedure::StepState>(step.state_())) {
    case Procedure::StepState::ahead: return "ahead";
    case Procedure::StepState::asks: return "waits for confirm";
    case Procedure::StepState::active: return "active";
    case Procedure::StepState::done: return "done";
    case Procedure::StepState::broken_off: return "broken off";
  }
  return "unknown";
}

}  // namespace

std::string step_that_asks(const msg::TaskState& state) {
  const auto asks = std::ranges::find_if(state.procedure_(), [](const msg::TaskStep& step) {
    return static_cast<Procedure::StepState>(step.state_()) == Procedure::StepState::asks;
  });
  return asks == state.procedure_().end() ? "" : asks->name_();
}

std::vector<std::string> steps_with_question(const msg::TaskState& state) {
  std::vector<std::string> names;
  for (const msg::TaskStep& step : state.procedure_()) {
    if (step.asks_()) names.push_back(step.name_());
  }
  return names;
}

std::string summary_of(const msg::TaskState& state) {
  std::string text = state.paused_() ? "paused, " : "";
  text += state.state_();
  if (state.steps_() > 0) text += fmt::format(" {}/{}", state.step_(), state.steps_());
  if (!state.detail_().empty()) text += ": " + state.detail_();
  for (const msg::TaskStep& step : state.procedure_()) {
    text += fmt::format(" {} {}", step.name_(), step.state_());
  }
  return text;
}

std::string table_of(const msg::TaskState& state) {
  std::string text = state.paused_() ? "paused, " : "";
  text += terminal_text(state.state_());
  if (!state.detail_().empty()) text += ": " + terminal_text(state.detail_());
  if (state.auto_confirm_()) text += " (nobody is asked: auto_confirm)";
  std::size_t width = 0;
  for (const msg::TaskStep& step : state.procedure_()) {
    width = std::max(width, terminal_text(step.name_()).size());
  }
  for (const msg::TaskStep& step : state.procedure_()) {
    text += fmt::format("\n  {:<{}}  {}", terminal_text(step.name_()), width, name_of(step));
  }
  return text;
}

nlohmann::ordered_json json_of(const msg::TaskState& state) {
  nlohmann::ordered_json steps = nlohmann::ordered_json::array();
  for (const msg::TaskStep& step : state.procedure_()) {
    steps.push_back({{"name", step.name_()}, {"state", name_of(step)}, {"asks", step.asks_()}});
  }
  return {{"state", state.state_()},
          {"detail", state.detail_()},
          {"paused", state.paused_()},
          {"auto_confirm", state.auto_confirm_()},
          {"steps", steps}};
}

std::string word_of(const std::string& typed) {
  for (const std::string_view word : kOperatorWords) {
    const bool meant = typed == word || (typed.size() == 1 && typed[0] == word[0]);
    if (meant) return std::string{word};
  }
  return "";
}

}  // namespace armature
