// SPDX-License-Identifier: Apache-2.0
#include "replay/comparison.hpp"

#include <algorithm>

#include "replay/changed_components.hpp"

namespace armature {
namespace {

/// Those of `run` that are other ones with the assignments.
std::vector<std::string> changed_of(const RecordedRun& run, PluginRegistry& plugins,
                                    const std::vector<std::string>& assignments) {
  std::vector<std::string> notes;  // are told by the sides
  std::vector<std::string> changed = changed_components(
      run.read_config(plugins, {}, notes), run.read_config(plugins, assignments, notes));
  std::erase_if(changed, [&](const std::string& name) { return !run.components().contains(name); });
  return changed;
}

/// No component has this name: none is constructed, instead of all.
std::vector<std::string> or_none(const std::vector<std::string>& names) {
  return names.empty() ? std::vector<std::string>{""} : names;
}

std::vector<const ReplayedMessage*> messages_of(const std::vector<ReplayedMessage>& all,
                                                const std::string& topic) {
  std::vector<const ReplayedMessage*> messages;
  for (const ReplayedMessage& message : all) {
    if (message.topic == topic) messages.push_back(&message);
  }
  return messages;
}

void compare_messages(const std::vector<ReplayedMessage>& before,
                      const std::vector<ReplayedMessage>& now, double at_s,
                      ComparedComponent& compared) {
  std::set<std::string> topics;
  for (const ReplayedMessage& message : before) topics.insert(message.topic);
  for (const ReplayedMessage& message : now) topics.insert(message.topic);
  for (const std::string& topic : topics) {
    const auto first = messages_of(before, topic), second = messages_of(now, topic);
    const std::size_t common = std::min(first.size(), second.size());
    TopicDifferences& differences = compared.topics[topic];
    for (std::size_t i = 0; i < common; ++i) {
      differences.compare(*first[i]->type, first[i]->cdr, second[i]->cdr, at_s);
    }
    for (std::size_t i = common; i < first.size(); ++i) {
      differences.add_only_before(*first[i]->type, first[i]->cdr);
    }
    for (std::size_t i = common; i < second.size(); ++i) {
      differences.add_only_now(*second[i]->type, second[i]->cdr);
    }
  }
}

void compare_failure(const std::string& recorded, const std::string& now, double at_s,
                     ComparedComponent& compared) {
  if (recorded == now || compared.failure) return;
  compared.failure = {.at_s = at_s, .recorded = recorded, .now = now};
}

}  // namespace

Comparison::Comparison(const std::filesystem::path& file, const std::string& process,
                       const ReplayOptions& options, PluginRegistry& plugins)
    : run_{file, process},
      changed_{changed_of(run_, plugins, options.assignments)},
      before_{run_, plugins, {}, or_none(changed_)},
      now_{run_, plugins, options.assignments, or_none(changed_)} {
  if (!options.allow_ulp && !changed_.empty()) check_processor(run_);
  run_.count_from_begin_of(options.files);
}

void Comparison::run() {
  while (const auto call = run_.next()) repeat(*call, run_.seconds_of(*call));
  for (const auto& [name, end] : run_.unrecorded_ends()) {
    const auto found = now_.process.entries().find(name);
    if (found != now_.process.entries().end() && !found->second.ends) found->second.ends = end;
  }
}

std::set<std::string> Comparison::notes() const {
  std::set<std::string> notes{before_.process.notes().begin(), before_.process.notes().end()};
  notes.insert(now_.process.notes().begin(), now_.process.notes().end());
  return notes;
}

bool Comparison::is_complete() const {
  const auto ends = [](const auto& entry) { return entry.second.ends.has_value(); };
  const auto is_unrecorded = [](const auto& held) { return held.second.unrecorded() > 0; };
  return problems().empty() && !components_.empty() &&
         std::ranges::none_of(repetitions_, is_unrecorded) &&
         std::ranges::none_of(before_.process.entries(), ends) &&
         std::ranges::none_of(now_.process.entries(), ends);
}

bool Comparison::repeats() const {
  return std::ranges::none_of(repetitions_,
                              [](const auto& held) { return held.second.otherwise().has_value(); });
}

void Comparison::repeat(const msg::Activation& call, double at_s) {
  // In turn, so that neither always finds the caches warm.
  now_first_ = !now_first_;
  ReplayedProcess::Entry* first = (now_first_ ? now_ : before_).process.repeat(call, at_s);
  ReplayedProcess::Entry* second = (now_first_ ? before_ : now_).process.repeat(call, at_s);
  const ReplayedProcess::Entry* before = now_first_ ? second : first;
  const ReplayedProcess::Entry* now = now_first_ ? first : second;
  if (before)
    repetitions_[call.component_()].hold(call, at_s, before->activations, *before->component, run_);
  if (!before || !now) return;
  ComparedComponent& compared = components_[call.component_()];
  compare_messages(before->component->published(), now->component->published(), at_s, compared);
  compare_failure(call.failure_(), now->component->failure().value_or(""), at_s, compared);
  const Duration took{now->component->runner().times().duration.counts().last_ns};
  if (compared.slowest_at_s && took <= compared.slowest) return;
  compared.slowest_at_s = at_s;
  compared.slowest = took;
}

}  // namespace armature
