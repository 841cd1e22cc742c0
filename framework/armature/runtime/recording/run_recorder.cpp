// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/recording/run_recorder.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "armature/bus/topic_name.hpp"
#include "armature/messages/known_types.hpp"
#include "armature/messages/ros_definition.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/recording/recorded_processes.hpp"
#include "armature/runtime/execution/real_time_thread.hpp"
#include "armature/runtime/plugins/processor_level.hpp"
#include "armature/runtime/recording/recorded_description.hpp"

namespace armature {
namespace {

constexpr std::size_t kRing = 1U << 12;  // parts of calls: about 0.5 s of a component at 1 kHz
constexpr std::size_t kManyCalls = 1000;
constexpr std::chrono::milliseconds kPause{5};
constexpr std::size_t kMaxOutOfOrder = 4096;

/// Whether a message may be as large as a picture.
bool has_bytes(const TypeDescription& type) {
  return std::ranges::any_of(type.fields, [](const FieldDescription& field) {
    if (field.kind == FieldKind::structure) return has_bytes(*field.structure);
    return field.kind == FieldKind::octet && field.shape == FieldDescription::Shape::sequence;
  });
}

/// How many samples of a topic wait for the recorder at a time.
std::size_t max_waiting(const MessageType& type) {
  const TypeDescription* description = describe_type(type.dds_name);
  return description && !has_bytes(*description) ? 64 : 4;
}

/// What the metadata of the process says of it.
std::string wholeness_of(const RunRecorder::Options& options) {
  if (options.around_faults) return "no";
  return options.thin ? "thin" : "yes";
}

/// How often messages are kept in a thin recording: twice as often as a page shows them, because
/// topics near its rate are shown whole.
std::optional<double> thin_rate_hz(const MessageType& type) {
  const TypeDescription* description = describe_type(type.dds_name);
  const auto hz = page_rate_hz(description ? ros2_name(*description) : "");
  return hz == kMaxPageHz ? 2 * kMaxPageHz : hz;
}

}  // namespace

McapQueue RunRecorder::queue_of(const Options& options, bool simulated) {
  McapWriter::Options writer{.library = "armature " ARMATURE_VERSION, .compress = options.compress};
  if (options.around_faults) {
    return McapQueue{{.before_and_after = *options.around_faults,
                      .file = options.file_at,
                      .told = [told = options.on_file](const auto& file) { told(file.string()); }},
                     std::move(writer)};
  }
  return McapQueue{options.file, std::move(writer),
                   simulated ? McapQueue::WhenFull::wait : McapQueue::WhenFull::drop};
}

bool RunRecorder::Sequences::add(std::uint64_t sequence) {
  if (sequence <= through_ || !ahead_.insert(sequence).second) return false;
  while (!ahead_.empty() && (*ahead_.begin() == through_ + 1 || ahead_.size() > kMaxOutOfOrder)) {
    through_ = *ahead_.begin();
    ahead_.erase(ahead_.begin());
  }
  return true;
}

RunRecorder::RunRecorder(Options options, const DeploymentConfig& deployment,
                         const Runners& runners, const Clock& clock)
    : options_{std::move(options)},
      clock_{clock},
      other_host_{deployment.host_of(options_.description.process_())},
      queue_{queue_of(options_, deployment.simulated)} {
  if (other_host_ == kMainHost) other_host_.clear();

  const msg::DeploymentDescription& description = options_.description;
  attach_description(description, clock.now(), queue_);
  std::map<std::string, std::string> process{{"process", description.process_()},
                                             {"processor", processor_level()},
                                             {"whole", wholeness_of(options_)}};
  if (!other_host_.empty()) {
    process[kHostKey] = other_host_;
    process[kClockAheadKey] = fmt::format("{:.6f}", to_seconds(clock_ahead()));
  }
  for (const auto& component : description.components_()) {
    for (const auto& plugin : component.plugins_()) {
      if (!plugin.library_().empty()) process["library of " + plugin.plugin_()] = plugin.sha256_();
    }
  }
  queue_.add(McapMetadata{.name = std::string{kProcessMetadata}, .values = std::move(process)});
  if (!options_.thin) {
    activations_ = queue_.add_channel("/" + deployment.name + "/activations",
                                      std::string{message_type<msg::Activation>().dds_name},
                                      {{kProcessKey, description.process_()}});
  }
  for (const auto& runner : runners) {
    const auto config =
        std::ranges::find(deployment.components, runner->name(), &ComponentConfig::name);
    add(*runner, *config, deployment, clock);
  }
  for (std::size_t i = 0; i < runners.size(); ++i) {
    runners[i]->inbox().set_tap(&components_[i]->log);
  }
  thread_ = std::thread{[this] { run(); }};
}

RunRecorder::~RunRecorder() { end_thread(); }

void RunRecorder::add(ComponentRunner& runner, const ComponentConfig& config,
                      const DeploymentConfig& deployment, const Clock& clock) {
  Component& component = *components_.emplace_back(
      std::make_unique<Component>(runner.name(), kRing, clock, deployment.simulated));
  component.is_of_runtime = config.manifest->file.empty();
  const std::string& process = options_.description.process_();
  std::map<std::string, std::string> ports{
      {"component", runner.name()}, {"plugin", runner.plugin_id()}, {kProcessKey, process}};
  int index = 0;
  for (const auto& input : runner.inbox().ports()) {
    const auto binding = std::ranges::find(config.inputs, input->spec().name,
                                           [](const PortBinding& port) { return port.spec.name; });
    const InputFromElsewhere from = deployment.from_elsewhere(*binding, process);
    // What is open may also come from programs that record nothing.
    const bool is_open = binding->spec.outside;
    component.inputs.push_back(
        {.topic = binding->topic,
         .type = &input->type(),
         .qos = input->spec().qos,
         .from = is_open ? "" : fmt::format("{}", fmt::join(from.processes, ",")),
         .is_numbered = from.is_numbered});
    ports[fmt::format("input {}", index++)] = input->spec().name;
  }
  for (OutputPort& output : runner.outputs()) {
    const MessageType& type = *output.topic().spec().type;
    const std::string topic = ros_topic_name(output.topic().spec().name);
    ports[fmt::format("writer {}", output.writer())] = output.spec().name;
    const Port port{.topic = topic, .type = &type, .qos = output.spec().qos};
    if (!add_channel(output.writer(), port).is_kept) continue;
    output.topic().reserve(max_waiting(type));
    if (is_read(topic, type)) output.topic().connect(reader_);
  }
  if (!component.is_of_runtime) {
    queue_.add(McapMetadata{.name = std::string{kComponentMetadata}, .values = std::move(ports)});
  }
}

/// Whether the topic is computed for the recording, too. Compressed pictures show what is recorded
/// raw.
bool RunRecorder::is_read(const std::string& topic, const MessageType& type) const {
  if (options_.topics.empty()) {
    return type.dds_name != message_type<msg::CompressedImage>().dds_name;
  }
  return std::ranges::find(options_.topics, topic) != options_.topics.end();
}

RunRecorder::Channel& RunRecorder::add_channel(std::uint32_t writer, const Port& port) {
  const bool is_kept = options_.topics.empty() ||
                       std::ranges::any_of(options_.topics, [&](const std::string& pattern) {
                         return matches_topic(pattern, port.topic);
                       });
  return channels_[writer] = {
             .topic = port.topic,
             .type = port.type,
             .qos = port.qos,
             .from = port.from,
             .is_numbered = port.is_numbered,
             .is_kept = is_kept,
             .thinning = Thinning{options_.thin ? thin_rate_hz(*port.type) : std::nullopt}};
}

void RunRecorder::run() {
  prepare_thread({.name = "recorder"});
  try {
    while (!ends_.load(std::memory_order_acquire)) {
      take_all();
      std::this_thread::sleep_for(kPause);
    }
    take_all();
  } catch (const std::exception& error) {
    tell_problem(error.what());
  }
}

/// Takes calls in the order of their times, whosesoever they are: a replay holds samples for a few
/// seconds only, and a simulated clock may be minutes ahead of this thread.
void RunRecorder::take_all() {
  const auto look_at_troubles = [this] {
    const std::int64_t trouble_ns = trouble_ns_.exchange(kNoTrouble, std::memory_order_relaxed);
    if (trouble_ns != kNoTrouble) queue_.mark(Time{trouble_ns});
    if (const std::string problem = queue_.problem(); !problem.empty()) tell_problem(problem);
  };
  std::vector<std::optional<ActivationLog::Entry>> begins(components_.size());  // of the next calls
  for (std::size_t calls = 1;; ++calls) {
    for (std::size_t i = 0; i < begins.size(); ++i) {
      if (!begins[i]) begins[i] = components_[i]->log.take();
    }
    const auto first = std::ranges::min_element(begins, {}, [](const auto& begin) {
      return begin ? begin->number : std::numeric_limits<std::int64_t>::max();
    });
    if (first == begins.end() || !*first) break;
    Component& component = *components_[static_cast<std::size_t>(first - begins.begin())];
    for (auto entry = std::exchange(*first, {}); entry; entry = component.log.take()) {
      take(component, *entry);
      if (entry->kind == ActivationLog::Entry::Kind::end) break;
    }
    if (calls % kManyCalls == 0) look_at_troubles();
  }
  look_at_troubles();
}

void RunRecorder::tell_problem(const std::string& problem) {
  if (std::exchange(told_problem_, true)) return;
  options_.on_problem(fmt::format("the recording ends here, the run goes on: {}", problem));
}

void RunRecorder::take(Component& component, ActivationLog::Entry& entry) {
  using Kind = ActivationLog::Entry::Kind;
  msg::Activation& call = component.call;
  switch (entry.kind) {
    case Kind::begin:
      call.call_(static_cast<std::uint8_t>(entry.call));
      set_stamp(call.now_(), Time{entry.number});
      call.lost_before_(0);
      call.read_().clear();
      call.had_subscribers_().clear();
      call.written_().clear();
      call.failure_().clear();
      return;
    case Kind::lost: call.lost_before_(static_cast<std::uint64_t>(entry.number)); return;
    case Kind::read: {
      const SampleInfo& info = entry.sample.info();
      const auto& input = component.inputs[static_cast<std::size_t>(entry.input)];
      const auto known = channels_.find(info.writer);
      keep(entry.sample, info.published,
           known == channels_.end() ? add_channel(info.writer, input) : known->second);
      msg::SampleRead& read = call.read_().emplace_back();
      read.input_(static_cast<std::uint16_t>(entry.input));
      read.writer_(info.writer);
      read.sequence_(info.sequence);
      set_stamp(read.published_(), info.published);
      return;
    }
    case Kind::answer: call.had_subscribers_().push_back(entry.answer); return;
    case Kind::published: {
      const SampleInfo& info = entry.sample.info();
      keep(entry.sample, Time{entry.number}, channels_.at(info.writer));
      msg::SampleWritten& written = call.written_().emplace_back();
      written.writer_(info.writer);
      written.sequence_(info.sequence);
      return;
    }
    case Kind::failed: call.failure_(component.log.failure()); return;
    case Kind::end:
      if (!component.is_of_runtime) write(call, stamp_of(call.now_()));
  }
}

/// Writes the sample, unless that was done for another reader of it.
void RunRecorder::keep(const SampleRef& sample, Time at, Channel& channel) {
  const SampleInfo& info = sample.info();
  if (!channel.is_kept || !channel.written.add(info.sequence)) return;
  if (!channel.thinning.passes(at)) {
    if (channel.from.empty()) ++thinned_;
    return;
  }
  if (!channel.id) {
    std::map<std::string, std::string> metadata{{"writer", fmt::format("{}", info.writer)},
                                                {"qos", std::string{to_string(channel.qos)}},
                                                {kProcessKey, options_.description.process_()}};
    if (!channel.from.empty()) metadata[kFromKey] = channel.from;
    if (channel.is_numbered) metadata[kNumberedKey] = "by its writer";
    channel.id =
        queue_.add_channel(channel.topic, std::string{channel.type->dds_name}, std::move(metadata));
  }
  std::vector<std::byte> cdr;
  channel.type->encode(sample.message(), cdr);
  queue_.write(*channel.id, static_cast<std::uint32_t>(info.sequence), at, at, std::move(cdr));
}

void RunRecorder::write(const msg::Activation& call, Time at) {
  if (options_.thin) return;
  std::vector<std::byte> cdr;
  message_type<msg::Activation>().encode(&call, cdr);
  queue_.write(activations_, static_cast<std::uint32_t>(++count_), at, at, std::move(cdr));
}

void RunRecorder::end_thread() {
  ends_.store(true, std::memory_order_release);
  if (thread_.joinable()) thread_.join();
}

std::string RunRecorder::close(const std::optional<McapAttachment>& figures) {
  end_thread();
  if (figures) queue_.attach(*figures);
  add_end();
  queue_.close();
  if (options_.around_faults) return {};
  std::uint64_t lost = 0, lost_calls = 0, strays = 0;
  for (const auto& component : components_) {
    lost += component->log.lost_samples();
    lost_calls += component->log.lost();
    strays += component->log.strays();
  }
  for (const auto& [channel, count] : queue_.dropped()) lost += count;
  std::string text = fmt::format("{}: {} messages, {} activations, {:.3f} MB, last hash {}",
                                 options_.file.string(), queue_.messages(), count_,
                                 1e-6 * static_cast<double>(queue_.bytes()), queue_.head());
  if (lost > 0) text += fmt::format("; {} came faster than they could be written", lost);
  if (lost_calls > 0) {
    text += fmt::format(
        "; {} calls of components are not in it, with all that they published: the "
        "recorder was too slow, or a call had more than {} messages",
        lost_calls, kRing - 2);
  }
  if (strays > 0)
    text += fmt::format("; {} samples of threads of components are not in it", strays);
  return text;
}

Duration RunRecorder::clock_ahead() const { return clock_.now() - SystemClock{}.now(); }

/// What a replay cannot see in the activations: how many there were, those that were lost last, and
/// calls that have not returned. Where this is missing, the recording was cut off.
void RunRecorder::add_end() {
  std::map<std::string, std::string> values{{kProcessKey, options_.description.process_()},
                                            {kActivationsKey, fmt::format("{}", count_)}};
  if (thinned_ > 0) values[kThinnedKey] = fmt::format("{}", thinned_);
  if (!other_host_.empty()) {
    values[kClockAheadKey] = fmt::format("{:.6f}", to_seconds(clock_ahead()));
  }
  for (const auto& component : components_) {
    const std::string& name = component->call.component_();
    if (component->is_of_runtime) continue;
    if (const auto lost = component->log.lost()) {
      values["lost of " + name] = fmt::format("{}", lost);
    }
    if (const auto strays = component->log.strays()) {
      values["strays of " + name] = fmt::format("{}", strays);
    }
    if (component->log.is_called()) values["running in " + name] = "1";
  }
  queue_.add(McapMetadata{.name = std::string{kEndMetadata}, .values = std::move(values)});
}

}  // namespace armature
