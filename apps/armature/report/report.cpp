// SPDX-License-Identifier: Apache-2.0
#include "report/report.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "armature/config/problems.hpp"
#include "armature/messages/known_types.hpp"
#include "armature/messages/ros_definition.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/recording/hash_chain.hpp"
#include "armature/recording/mcap_reader.hpp"
#include "armature/recording/mcap_writer.hpp"
#include "armature/recording/recorded_processes.hpp"
#include "armature/runtime/recording/page_rate.hpp"
#include "armature/runtime/recording/recorded_description.hpp"
#include "armature/runtime/reporting/write_atomically.hpp"
#include "armature/values/json_text.hpp"
#include "exit_code.hpp"
#include "jpeg_encoder.hpp"
#include "record/message_copy.hpp"
#include "record/record.hpp"
#include "standard_output.hpp"
#include "verbs/shipped_configs.hpp"

namespace armature {
namespace {

constexpr std::uint64_t kMaxBytes = 256'000'000;  // browsers hold texts of 512 MB at most
constexpr int kJpegQuality = 80;
constexpr std::string_view kImage = "sensor_msgs/msg/Image";
constexpr std::string_view kCompressedImage = "sensor_msgs/msg/CompressedImage";

/// What is known of a recording after it was read once.
struct RunContents {
  struct Topic {
    std::string type;
    std::uint64_t messages = 0;
  };
  std::map<std::string, Topic> topics;
  std::uint64_t messages = 0;
  Time first, last;
  McapChain chain;
  bool is_whole = true;
  std::vector<std::string> processes;             // whose recordings are in it
  std::map<std::string, std::string> deployment;  // version, fingerprint, ..
  std::string figures;                            // of the run, as JSON; empty: it has none

  double hz(const Topic& topic) const {
    const double length_s = to_seconds(last - first);
    return length_s > 0 ? static_cast<double>(topic.messages) / length_s : 0;
  }
};

RunContents read_all(const std::filesystem::path& file) {
  McapReader reader{file, true};
  RunContents contents;
  contents.processes = recorded_processes(file);
  while (const auto message = reader.next()) {
    if (is_doubled(*message->channel, contents.processes)) continue;
    ++contents.topics[message->channel->topic].messages;
    const bool is_first = contents.messages++ == 0;
    contents.first = is_first ? message->log_time : std::min(contents.first, message->log_time);
    contents.last = is_first ? message->log_time : std::max(contents.last, message->log_time);
  }
  for (const auto& [id, channel] : reader.channels()) {
    const auto schema = reader.schemas().find(channel.schema_id);
    const auto topic = contents.topics.find(channel.topic);
    if (schema == reader.schemas().end() || topic == contents.topics.end()) continue;
    topic->second.type = schema->second.name;
  }
  contents.chain = reader.chain();
  contents.is_whole = reader.problems().empty();
  for (const McapMetadata& metadata : reader.metadata()) {
    if (metadata.name == kDeploymentMetadata) contents.deployment = metadata.values;
  }
  for (const McapAttachment& attachment : reader.attachments()) {
    if (attachment.name == kFiguresAttachment) contents.figures = attachment.data;
  }
  return contents;
}

/// How often a topic is kept: 0: not at all; nothing: all of it.
std::optional<double> kept_hz(const std::string& name, const RunContents& contents, bool pictures) {
  const RunContents::Topic& topic = contents.topics.at(name);
  const bool is_raw = topic.type == kImage, is_picture = is_raw || topic.type == kCompressedImage;
  const bool has_jpeg = is_raw && contents.topics.contains(name + "/compressed");
  if ((is_picture && !pictures) || has_jpeg) return 0;
  const std::optional<double> hz = page_rate_hz(topic.type);
  return hz == kMaxPageHz && contents.hz(topic) <= kMaxPageHz ? std::nullopt : hz;
}

/// A file without a name, in memory: it is gone with its owner, however the program ends.
class MemoryFile {
 public:
  MemoryFile() : descriptor_{memfd_create("report", MFD_CLOEXEC)} {
    if (descriptor_ < 0) throw std::runtime_error{std::strerror(errno)};
  }
  ~MemoryFile() { close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::filesystem::path path() const { return fmt::format("/proc/self/fd/{}", descriptor_); }

 private:
  int descriptor_;
};

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream stream{file, std::ios::binary};
  if (!stream) {
    throw std::runtime_error{
        fmt::format("cannot read '{}': {}", file.string(), std::strerror(errno))};
  }
  return {std::istreambuf_iterator<char>{stream}, {}};
}

/// Puts raw pictures as JPEG where the page looks for such: <image>/compressed.
class PictureCopy {
 public:
  /// `to` outlives it.
  explicit PictureCopy(McapWriter& to) : to_{to} {}

  /// False: it is of another encoding than JPEG has, or no picture; nothing was written.
  bool write(const McapMessage& message) {
    const MessageType& raw = message_type<msg::Image>();
    if (!raw.decode(message.data, &image_)) return false;
    if (!encoder_.encode(image_, compressed_.data_())) return false;
    compressed_.header_(image_.header_());
    compressed_.format_("jpeg");
    cdr_.clear();
    message_type<msg::CompressedImage>().encode(&compressed_, cdr_);
    to_.write(channel_of(message.channel->topic + "/compressed"), message.sequence,
              message.log_time, message.publish_time, cdr_);
    return true;
  }

 private:
  std::uint16_t channel_of(const std::string& topic) {
    const auto [place, is_new] = channels_.try_emplace(topic);
    if (!is_new) return place->second;
    const std::string dds_type{message_type<msg::CompressedImage>().dds_name};
    if (schema_ == 0) {
      const TypeDescription& type = *describe_type(dds_type);
      schema_ = to_.add(
          McapSchema{.name = ros2_name(type), .encoding = "ros2msg", .data = ros_definition(type)});
    }
    place->second = to_.add(McapChannel{.schema_id = schema_,
                                        .topic = topic,
                                        .message_encoding = "cdr",
                                        .metadata = {{"dds_type", dds_type}}});
    return place->second;
  }

  McapWriter& to_;
  jpeg::JpegEncoder encoder_{kJpegQuality};
  msg::Image image_;
  msg::CompressedImage compressed_;
  std::vector<std::byte> cdr_;
  std::uint16_t schema_ = 0;
  std::map<std::string, std::uint16_t> channels_;  // by topic
};

struct Reduced {
  std::string bytes;
  std::uint64_t messages = 0;
};

/// The recording, as it stands in the page.
Reduced reduced(const ReportOptions& options, const RunContents& contents) {
  const MemoryFile file;
  McapReader reader{options.recording};
  McapWriter writer{file.path(), {.library = "armature " ARMATURE_VERSION}};
  MessageCopy copy{reader, writer};
  PictureCopy pictures{writer};
  std::map<std::string, Thinning> topics;
  while (const auto message = reader.next()) {
    const McapChannel& channel = *message->channel;
    if (is_doubled(channel, contents.processes)) continue;
    if (!topics.contains(channel.topic)) {
      topics.emplace(channel.topic, kept_hz(channel.topic, contents, options.pictures));
    }
    if (!topics.at(channel.topic).passes(message->log_time)) continue;
    const bool is_raw = contents.topics.at(channel.topic).type == kImage;
    if (!is_raw || !pictures.write(*message)) copy.write(*message);
    if (writer.bytes() > kMaxBytes) {
      throw InvalidChoice(fmt::format(
          "'{}' is too long for a page: more than {} MB even with fewer messages; record a shorter "
          "time, fewer topics, or leave the pictures out: --without-pictures",
          options.recording.string(), kMaxBytes / 1'000'000));
    }
  }
  for (const McapAttachment& attachment : reader.attachments()) writer.attach(attachment);
  for (const McapMetadata& metadata : reader.metadata()) writer.add(metadata);
  writer.close();
  return {.bytes = bytes_of(file.path()), .messages = writer.messages()};
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      group = group << 8 | (j < count ? static_cast<unsigned char>(bytes[i + j]) : 0U);
    }
    for (std::size_t j = 0; j < 4; ++j) {
      text += j <= count ? kDigits[group >> (18 - 6 * j) & 63] : '=';
    }
  }
  return text;
}

/// As the value of an attribute in quotes.
std::string escaped(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string utc(Time time) {
  return fmt::format("{:%Y-%m-%d %H:%M:%S} UTC",
                     fmt::gmtime(static_cast<std::time_t>(time.ns / 1'000'000'000)));
}

std::string_view state_of(const RunContents& contents) {
  switch (contents.chain.verdict) {
    case McapChain::Verdict::whole:
      return contents.is_whole ? "whole and unchanged" : "not whole";
    case McapChain::Verdict::cut:
      return "cut off";
    case McapChain::Verdict::changed:
      return "changed after it was written";
    case McapChain::Verdict::none:
      break;
  }
  return contents.is_whole ? "without a chain of hashes" : "not whole";
}

/// The page moves the arm by what viewers are told, and what nobody reads is not recorded.
bool shows_moving_arm(const RunContents& contents) {
  const auto has = [&](const char* topic) { return contents.topics.contains(topic); };
  return !has("/robot_description") || (has("/joint_states") && has("/tf"));
}

/// What the page tells of itself: a name and a text, in this order.
nlohmann::ordered_json provenance(const ReportOptions& options, const RunContents& contents,
                                  const Reduced& kept) {
  nlohmann::ordered_json told = nlohmann::ordered_json::array();
  const auto add = [&](std::string_view name, std::string text) {
    if (!text.empty()) told.push_back({name, std::move(text)});
  };
  const auto of_deployment = [&](const char* name) {
    const auto found = contents.deployment.find(name);
    return found == contents.deployment.end() ? std::string{} : found->second;
  };
  add("Recording", options.recording.filename().string());
  add("SHA-256", sha256_of_file(options.recording));
  add("Last hash", contents.chain.head);
  add("Checked", std::string{state_of(contents)});
  add("Recorded",
      fmt::format("{}, {:.1f} s", utc(contents.first), to_seconds(contents.last - contents.first)));
  add("Deployment", of_deployment("deployment"));
  add("Version", of_deployment("version"));
  add("Fingerprint", of_deployment("fingerprint"));
  add("Clock", of_deployment("clock"));
  add("In this page", fmt::format("{} of {} messages: at most {} a second of a topic, {} of a "
                                  "camera{}",
                                  kept.messages, contents.messages, kMaxPageHz, kMaxPagePictureHz,
                                  options.pictures ? "" : "; without pictures"));
  add("Page by", "armature " ARMATURE_VERSION);
  return told;
}

/// What whoever made the page should know.
std::vector<std::string> notes_on(const ReportOptions& options, const RunContents& contents) {
  std::vector<std::string> notes;
  const auto note = [&](std::string_view text) {
    notes.push_back(fmt::format("'{}' {}", options.recording.string(), text));
  };
  if (!contents.is_whole || contents.chain.verdict == McapChain::Verdict::changed) {
    note(fmt::format("is {}: the page says so", state_of(contents)));
  }
  if (!shows_moving_arm(contents)) {
    note(
        "has no /joint_states or no /tf: the page does not show how the arm moved (name both "
        "under record: topics)");
  }
  return notes;
}

}  // namespace

WrittenReport write_report(const ReportOptions& options) {
  std::error_code error;
  if (std::filesystem::equivalent(options.recording, options.out, error)) {
    throw InvalidChoice(fmt::format("'{}' is the recording itself", options.out.string()));
  }
  refuse_to_replace(options.out, options.force);
  std::string page =
      bytes_of(options.page.empty() ? shipped_folder("monitor") / "index.html" : options.page);
  constexpr std::string_view kScript = "<script type=\"module\">";
  const std::size_t place = page.find(kScript);
  if (place == std::string::npos) throw std::runtime_error{"the page of the monitor has no script"};

  const RunContents contents = read_all(options.recording);
  if (contents.messages == 0) {
    throw InvalidChoice(fmt::format("'{}' has no messages", options.recording.string()));
  }
  const Reduced kept = reduced(options, contents);
  page.insert(place,
              fmt::format("<script type=\"application/octet-stream;base64\" id=\"recording\" "
                          "data-name=\"{}\" data-told=\"{}\" data-figures=\"{}\">{}</script>\n",
                          escaped(options.recording.filename().string()),
                          escaped(json_text(provenance(options, contents, kept))),
                          escaped(contents.figures), base64(kept.bytes)));
  write_atomically(options.out, page, options.use);
  return {
      .text = fmt::format("{}: {} of {} messages, {:.3f} MB", options.out.string(), kept.messages,
                          contents.messages, 1e-6 * static_cast<double>(page.size())),
      .notes = notes_on(options, contents)};
}

int print_report(const ReportOptions& options) {
  const WrittenReport written = write_report(options);
  for (const std::string& note : written.notes) fmt::print(stderr, "armature: {}\n", note);
  print_out("{}\n", written.text);
  return kOk;
}

}  // namespace armature
