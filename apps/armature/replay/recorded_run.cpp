// SPDX-License-Identifier: Apache-2.0
#include "replay/recorded_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "armature/config/document.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/recording/recorded_processes.hpp"
#include "armature/runtime/recording/recorded_description.hpp"
#include "record/repaired.hpp"

namespace armature {
namespace {

constexpr std::size_t kMinKept = 8;
constexpr std::string_view kOwnLibrary =
    "armature";                             // which writes a chain of hashes into every file
constexpr std::uint32_t kMaxInputs = 1000;  // of a component

/// Throws std::runtime_error for what is no number up to `max`.
std::uint32_t number_of(std::string_view text,
                        std::uint32_t max = std::numeric_limits<std::uint32_t>::max()) {
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc{} && end == text.data() + text.size() && number <= max) return number;
  throw std::runtime_error(
      fmt::format("the recording has a number that is none: {}", config::in_quotes(text)));
}

/// What stands behind `beginning`, or nothing.
std::optional<std::string> behind(std::string_view beginning, const std::string& key) {
  if (!key.starts_with(beginning)) return std::nullopt;
  return key.substr(beginning.size());
}

}  // namespace

RecordedRun::RecordedRun(const std::filesystem::path& file, std::string process)
    : file_{file}, process_{std::move(process)}, reader_{file, true} {
  read_metadata(file);
  if (!deployment_.empty() && !components_.empty()) return;
  throw std::runtime_error(fmt::format(
      "'{}' holds no activations: only what a deployment records of itself can be replayed, "
      "record: {{file: run.mcap}}",
      file.string()));
}

/// True also for what was recorded before files could be joined.
bool RecordedRun::is_mine(const std::map<std::string, std::string>& metadata) const {
  const auto process = metadata.find(kProcessKey);
  return process == metadata.end() || process->second == process_;
}

/// They stand at the beginning, but behind everything in a recording that an older version
/// repaired.
void RecordedRun::read_metadata(const std::filesystem::path& file) {
  McapReader reader{file};
  const auto has_all = [&] {
    return std::ranges::any_of(reader.metadata(), [&](const McapMetadata& metadata) {
      return metadata.name == kComponentMetadata && is_mine(metadata.values);
    });
  };
  while (reader.next() && !has_all()) continue;
  problems_ = reader.problems();
  for (const McapMetadata& metadata : reader.metadata()) {
    if (metadata.name == kDeploymentMetadata) {
      for (const auto& [key, value] : metadata.values) {
        if (key == "deployment") deployment_ = value;
        if (key == "run") run_ = value;
        if (const auto name = behind("file of ", key)) files_[*name] = value;
      }
    }
    if (!is_mine(metadata.values)) continue;
    if (metadata.name == kProcessMetadata) read_process(metadata);
    if (metadata.name == kComponentMetadata) read_ports(metadata);
  }
  for (const McapAttachment& attachment : reader.attachments()) {
    if (const auto name = behind(deployment_ + "/", attachment.name)) {
      texts_[*name] = attachment.data;
    }
  }
}

void RecordedRun::read_process(const McapMetadata& metadata) {
  for (const auto& [key, value] : metadata.values) {
    if (key == "processor") processor_ = value;
    if (key == "whole" && value == "no") {
      throw std::runtime_error(
          fmt::format("'{}' begins in the midst of a run (around_faults_s), and components "
                      "cannot be repeated without what they had done before",
                      file_.string()));
    }
    if (key == "whole" && value == "thin") {
      throw std::runtime_error(
          fmt::format("'{}' has only what a page of the run shows (record: thin), and no "
                      "activations to be repeated",
                      file_.string()));
    }
    if (const auto plugin = behind("library of ", key)) libraries_[*plugin] = value;
  }
}

void RecordedRun::read_ports(const McapMetadata& metadata) {
  RecordedPorts ports;
  std::string component;
  for (const auto& [key, value] : metadata.values) {
    if (key == "component") component = value;
    if (const auto writer = behind("writer ", key)) ports.outputs[number_of(*writer)] = value;
    if (const auto input = behind("input ", key)) {
      const std::size_t index = number_of(*input, kMaxInputs);
      if (ports.inputs.size() <= index) ports.inputs.resize(index + 1);
      ports.inputs[index] = value;
    }
  }
  components_[component] = std::move(ports);
}

DeploymentConfig RecordedRun::read_config(const PluginRegistry& plugins,
                                          const std::vector<std::string>& assignments,
                                          std::vector<std::string>& notes) const {
  RecordedDocuments documents;
  config::Node root;
  for (const auto& [name, text] : texts_) {
    const std::string document = name.substr(0, name.rfind(".yaml"));
    const auto file = files_.find(document);
    if (file == files_.end()) {
      root = config::parse_text(text, file_.string() + ":" + name);
    } else {  // what it names is found from where it was
      documents.emplace(document, config::parse_text(text, file->second));
    }
  }
  if (root.kind() == config::Node::Kind::null) {
    throw std::runtime_error(
        fmt::format("'{}' does not hold the file of its deployment: nothing of it can be repeated",
                    file_.string()));
  }
  config::Problems problems;
  DeploymentConfig config =
      read_deployment(config::with_assignments(std::move(root), assignments, &notes), plugins,
                      problems, &documents);
  problems.throw_if_any();
  return config;
}

std::optional<msg::Activation> RecordedRun::next() {
  const MessageType& type = message_type<msg::Activation>();
  while (const auto message = reader_.next()) {
    const auto& channel = message->channel->metadata;
    const auto dds_type = channel.find("dds_type");
    if (dds_type == channel.end() || !is_mine(channel)) continue;
    if (dds_type->second != type.dds_name) {
      keep(*message);
      continue;
    }
    if (!is_next(message->sequence)) return std::nullopt;
    msg::Activation activation;
    if (type.decode(message->data, &activation)) return activation;
    throw std::runtime_error(
        fmt::format("'{}' holds activations of another version", file_.string()));
  }
  is_read_to_end_ = true;
  return std::nullopt;
}

void RecordedRun::count_from_begin_of(const std::vector<std::filesystem::path>& files) {
  std::optional<Time> begin;
  for (const std::filesystem::path& file : files) {
    McapReader reader{file};
    if (const auto first = reader.next()) {
      begin = std::min(begin.value_or(first->log_time), first->log_time);
    }
  }
  begin_ = begin.value_or(Time{});
}

double RecordedRun::seconds_of(const msg::Activation& call) const {
  return std::max(to_seconds(stamp_of(call.now_()) - begin_), 0.0);
}

/// Activations are numbered without a gap, whatever component they are of.
bool RecordedRun::is_next(std::uint32_t sequence) {
  const std::uint32_t missing = sequence - last_activation_ - 1;
  last_activation_ = sequence;
  if (missing == 0) return true;
  problems_.push_back(fmt::format(
      "activations are missing before the {}th: everything is replayed up to there", sequence));
  return false;
}

/// Holds samples for as long as a call may last: the record of a call comes after its end.
void RecordedRun::keep_for_call(Duration longest) {
  constexpr Duration kBefore = seconds(1);
  kept_for_ = std::max(kept_for_, longest + kBefore);
}

void RecordedRun::keep_at_least(const std::string& topic, std::size_t samples) {
  std::size_t& kept = min_kept_[topic];
  kept = std::max(kept, samples + kMinKept);
}

std::vector<std::string> RecordedRun::problems() const {
  std::vector<std::string> problems = problems_;
  const auto add = [&](const std::string& problem) {
    if (std::ranges::find(problems, problem) == problems.end()) problems.push_back(problem);
  };
  for (const std::string& problem : reader_.problems()) add(problem);
  const McapChain chain = is_read_to_end_ ? reader_.chain() : McapChain{};
  if (is_read_to_end_ && chain.verdict == McapChain::Verdict::none &&
      reader_.library().starts_with(kOwnLibrary)) {
    add("its chain of hashes is gone: whether it was changed cannot be told");
  }
  for (const std::string& change : chain.changes) {
    add("it was changed after it was written: " + change);
  }
  // Of what was joined, the file is whole where the part was not.
  for (const std::string& repair : repairs_told_by(reader_.metadata(), process_)) add(repair);
  const auto end = std::ranges::find_if(reader_.metadata(), [&](const McapMetadata& metadata) {
    return metadata.name == kEndMetadata && is_mine(metadata.values);
  });
  if (end == reader_.metadata().end()) {
    add(fmt::format("the recording of process '{}' has no end", process_));
    return problems;
  }
  const auto count = end->values.find(kActivationsKey);
  if (count == end->values.end()) return problems;  // of an older version
  if (const std::uint32_t all = number_of(count->second); all > last_activation_) {
    add(fmt::format("the last {} of the {} activations of process '{}' are missing",
                    all - last_activation_, all, process_));
  }
  return problems;
}

std::map<std::string, std::string> RecordedRun::unrecorded_ends() const {
  std::map<std::string, std::string> ends;
  for (const McapMetadata& metadata : reader_.metadata()) {
    if (metadata.name != kEndMetadata || !is_mine(metadata.values)) continue;
    for (const auto& [key, value] : metadata.values) {
      if (const auto name = behind("lost of ", key)) {
        ends[*name] = fmt::format("{} of its activations were not recorded", value);
      }
      if (const auto name = behind("strays of ", key)) {
        std::string& end = ends[*name];
        end += fmt::format("{}{} messages of threads of its own were not recorded",
                           end.empty() ? "" : ", ", value);
      }
      if (const auto name = behind("running in ", key))
        ends[*name] = "its last call did not return";
    }
  }
  return ends;
}

void RecordedRun::keep(const McapMessage& message) {
  auto writer = writers_.find(message.channel->id);
  if (writer == writers_.end()) {
    const auto known = message.channel->metadata.find("writer");
    if (known == message.channel->metadata.end()) return;
    writer = writers_.emplace(message.channel->id, number_of(known->second)).first;
  }
  std::deque<Sample>& samples = samples_[writer->second];
  samples.push_back({.sequence = message.sequence,
                     .at = message.log_time,
                     .cdr = {message.data.begin(), message.data.end()}});
  const auto known = min_kept_.find(message.channel->topic);
  const std::size_t min_kept = known == min_kept_.end() ? kMinKept : known->second;
  // It may have waited for its reader until so many more had come, however long that took.
  while (samples.size() > min_kept && samples[min_kept].at < message.log_time - kept_for_) {
    let_go_[writer->second] = samples.front().sequence;
    samples.pop_front();
  }
}

std::optional<std::span<const std::byte>> RecordedRun::sample(std::uint32_t writer,
                                                              std::uint64_t sequence) const {
  const auto samples = samples_.find(writer);
  if (samples == samples_.end()) return std::nullopt;
  const auto wanted = static_cast<std::uint32_t>(sequence);
  const auto found = std::find_if(samples->second.rbegin(), samples->second.rend(),
                                  [&](const Sample& sample) { return sample.sequence == wanted; });
  if (found == samples->second.rend()) return std::nullopt;
  return found->cdr;
}

bool RecordedRun::was_let_go(std::uint32_t writer, std::uint64_t sequence) const {
  const auto last = let_go_.find(writer);
  return last != let_go_.end() && static_cast<std::uint32_t>(sequence) <= last->second;
}

}  // namespace armature
