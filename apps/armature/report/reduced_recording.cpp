// SPDX-License-Identifier: Apache-2.0
#include "report/reduced_recording.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "armature/messages/known_types.hpp"
#include "armature/messages/ros_definition.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/recording/mcap_writer.hpp"
#include "armature/runtime/recording/page_rate.hpp"
#include "armature/runtime/recording/recorded_description.hpp"
#include "exit_code.hpp"
#include "jpeg_encoder.hpp"
#include "record/message_copy.hpp"
#include "record/repaired.hpp"

namespace armature {
namespace {

constexpr std::uint64_t kMaxBytes = 256'000'000;  // browsers hold texts of 512 MB at most
constexpr int kJpegQuality = 80;
constexpr std::string_view kImage = "sensor_msgs/msg/Image";
constexpr std::string_view kCompressedImage = "sensor_msgs/msg/CompressedImage";

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

}  // namespace

RunContents read_contents(const std::filesystem::path& file) {
  McapReader reader{file, true};
  RunContents contents;
  contents.copies = RecordedCopies{file};
  while (const auto message = reader.next()) {
    if (contents.copies.has(*message)) continue;
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
  contents.repairs = repairs_told_by(reader.metadata());
  std::ranges::move(losses_told_by(reader.metadata()), std::back_inserter(contents.repairs));
  for (const McapMetadata& metadata : reader.metadata()) {
    if (metadata.name == kDeploymentMetadata) contents.deployment = metadata.values;
    if (metadata.name != kEndMetadata) continue;
    const auto thinned = metadata.values.find(kThinnedKey);
    if (thinned == metadata.values.end()) continue;
    std::uint64_t count = 0;
    std::from_chars(thinned->second.data(), thinned->second.data() + thinned->second.size(), count);
    contents.thinned += count;
  }
  for (const McapAttachment& attachment : reader.attachments()) {
    if (attachment.name == kFiguresAttachment) contents.figures = attachment.data;
  }
  return contents;
}

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream stream{file, std::ios::binary};
  if (!stream) {
    throw std::runtime_error{
        fmt::format("cannot read '{}': {}", file.string(), std::strerror(errno))};
  }
  return {std::istreambuf_iterator<char>{stream}, {}};
}

Reduced reduced(const std::filesystem::path& recording, const RunContents& contents,
                bool with_pictures) {
  const MemoryFile file;
  McapReader reader{recording};
  McapWriter writer{file.path(), {.library = "armature " ARMATURE_VERSION}};
  MessageCopy copy{reader, writer};
  PictureCopy pictures{writer};
  std::map<std::uint16_t, Thinning> channels;  // several may write a topic, at the same times
  std::uint64_t seen = 0;
  while (const auto message = reader.next()) {
    const McapChannel& channel = *message->channel;
    if (contents.copies.has(*message)) continue;
    const auto topic = contents.topics.find(channel.topic);
    if (topic == contents.topics.end() || ++seen > contents.messages) continue;
    if (!channels.contains(channel.id)) {
      channels.emplace(channel.id, kept_hz(channel.topic, contents, with_pictures));
    }
    if (!channels.at(channel.id).passes(message->log_time)) continue;
    const bool is_raw = topic->second.type == kImage;
    if (!is_raw || !pictures.write(*message)) copy.write(*message);
    if (writer.bytes() > kMaxBytes) {
      throw InvalidChoice(fmt::format(
          "'{}' is too long for a page: more than {} MB even with fewer messages; record a shorter "
          "time, fewer topics, or leave the pictures out: --without-pictures",
          recording.string(), kMaxBytes / 1'000'000));
    }
  }
  for (const McapAttachment& attachment : reader.attachments()) writer.attach(attachment);
  for (const McapMetadata& metadata : reader.metadata()) writer.add(metadata);
  writer.close();
  return {.bytes = bytes_of(file.path()), .messages = writer.messages()};
}

}  // namespace armature
