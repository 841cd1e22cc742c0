// SPDX-License-Identifier: Apache-2.0
#include "recorded_pictures.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "armature/messages/stamp.hpp"
#include "armature/recording/mcap_summary.hpp"
#include "armature/recording/recorded_processes.hpp"
#include "armature/runtime/plugins/setup_error.hpp"

namespace armature::camera::images {
namespace {

constexpr Duration kUsualInterval = seconds(0.1);  // until two pictures tell a better one
constexpr int kMaxLooked = 1000;  // messages until it says that there is nothing yet
constexpr std::string_view kImage = "sensor_msgs/msg/Image";
constexpr std::string_view kCompressed = "sensor_msgs/msg/CompressedImage";

bool is_named(std::string_view topic, std::string_view name) {
  return topic == name || (topic.ends_with(name) && !name.starts_with('/') &&
                           topic.substr(0, topic.size() - name.size()).ends_with('/'));
}

bool has_pictures(const std::map<std::uint16_t, McapSchema>& schemas, const McapChannel& channel) {
  const auto schema = schemas.find(channel.schema_id);
  return schema != schemas.end() &&
         (schema->second.name == kImage || schema->second.name == kCompressed);
}

/// The one topic that is meant by `name`.
std::string topic_of(const McapSummary& summary, const std::filesystem::path& file,
                     const std::string& parameter, const std::string& name) {
  std::vector<std::string> pictures, meant;
  for (const auto& [id, channel] : summary.channels) {
    if (!has_pictures(summary.schemas, channel)) continue;
    pictures.push_back(channel.topic);
    if (is_named(channel.topic, name)) meant.push_back(channel.topic);
  }
  for (auto* names : {&pictures, &meant}) {
    std::ranges::sort(*names);
    names->erase(std::unique(names->begin(), names->end()), names->end());
  }
  if (meant.size() == 1) return meant.front();
  if (meant.size() > 1) {
    throw SetupError(fmt::format("{}: '{}' may be any of {} in '{}'; write the whole name",
                                 parameter, name, fmt::join(meant, ", "), file.string()));
  }
  throw SetupError(fmt::format(
      "{}: '{}' has no pictures of '{}'; {}", parameter, file.string(), name,
      pictures.empty() ? "there is no topic of sensor_msgs/Image in it"
                       : fmt::format("those with pictures are {}", fmt::join(pictures, ", "))));
}

template <class Message>
std::optional<Message> decoded(const McapMessage& message) {
  Message decoded_message;
  if (!message_type<Message>().decode(message.data, &decoded_message)) return std::nullopt;
  return decoded_message;
}

}  // namespace

RecordedPictures::RecordedPictures(std::filesystem::path file, std::string left, std::string right)
    : file_{std::move(file)},
      left_{std::move(left)},
      right_{std::move(right)},
      last_interval_{kUsualInterval} {
  if (left_ == right_) {
    throw SetupError(fmt::format("left_topic and right_topic are both '{}'", left_));
  }
  try {
    if (const auto summary = read_summary(file_)) {
      left_ = topic_of(*summary, file_, "left_topic", left_);
      right_ = topic_of(*summary, file_, "right_topic", right_);
    }
    copies_ = RecordedCopies{file_};
    reader_ = std::make_unique<McapReader>(file_);
  } catch (const SetupError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw SetupError(fmt::format("recording: {}", error.what()));
  }
}

std::optional<pictures::Side> RecordedPictures::side_of(const McapMessage& message) const {
  if (!has_pictures(reader_->schemas(), *message.channel)) return std::nullopt;
  if (copies_.has(message)) return std::nullopt;
  if (is_named(message.channel->topic, left_)) return pictures::Side::left;
  if (is_named(message.channel->topic, right_)) return pictures::Side::right;
  return std::nullopt;
}

pictures::TimedPicture RecordedPictures::picture_of(pictures::Side side,
                                                    const McapMessage& message) const {
  pictures::TimedPicture timed{.side = side,
                               .stamp = message.publish_time,
                               .published = message.publish_time,
                               .picture = refuse("")};
  const auto because = [&](const std::string& reason) {
    return refuse(fmt::format("{}: the picture of {} that was published at {:.6f} s: {}",
                              file_.string(), message.channel->topic,
                              to_seconds(message.publish_time - Time{}), reason));
  };
  const auto take = [&](Time stamp, Expected<pictures::GrayPicture> picture) {
    timed.stamp = stamp;
    timed.picture = picture ? std::move(picture) : because(picture.error().text);
  };
  if (reader_->schemas().at(message.channel->schema_id).name == kImage) {
    if (const auto image = decoded<msg::Image>(message)) {
      take(stamp_of(image->header_().stamp_()), pictures::gray_picture_of(*image));
      return timed;
    }
  } else if (const auto image = decoded<msg::CompressedImage>(message)) {
    take(stamp_of(image->header_().stamp_()), pictures::decode_picture(image->data_()));
    return timed;
  }
  timed.picture = because("its bytes are no message of its type");
  return timed;
}

std::optional<pictures::TimedPicture> RecordedPictures::read_next() {
  try {
    for (int looked = 0; looked < kMaxLooked; ++looked) {
      const auto message = reader_->next();
      if (!message) {
        ended_ = true;
        return std::nullopt;
      }
      const auto side = side_of(*message);
      if (!side) continue;
      std::string& topic = topics_[static_cast<std::size_t>(*side)];
      if (topic.empty()) topic = message->channel->topic;
      if (topic != message->channel->topic) {
        return damage(fmt::format("'{}' may be {} or {}; write the whole name",
                                  *side == pictures::Side::left ? left_ : right_, topic,
                                  message->channel->topic));
      }
      if (*side == pictures::Side::left) {
        if (last_left_ && message->publish_time > *last_left_) {
          last_interval_ = message->publish_time - *last_left_;
        }
        last_left_ = message->publish_time;
      }
      return picture_of(*side, *message);
    }
  } catch (const std::runtime_error& error) {
    error_ = error.what();
    ended_ = true;
  }
  return std::nullopt;
}

pictures::TimedPicture RecordedPictures::damage(const std::string& problem) {
  const std::string told = file_.string() + ": " + problem;
  if (remark_.empty()) remark_ = told;
  return {.picture = refuse(told)};
}

std::optional<pictures::TimedPicture> RecordedPictures::next() {
  if (!next_ && !ended_) next_ = read_next();
  if (told_ < reader_->problems().size()) return damage(reader_->problems()[told_++]);
  if (!error_.empty()) return damage(std::exchange(error_, {}));
  return std::exchange(next_, std::nullopt);
}

void RecordedPictures::rewind() {
  reader_ = std::make_unique<McapReader>(file_);
  last_left_.reset();
  ended_ = false;
  told_ = 0;
}

}  // namespace armature::camera::images
