// SPDX-License-Identifier: Apache-2.0
#include "replay/announced_volumes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <tuple>

#include "armature/kinds/volume_messages.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/recording/mcap_reader.hpp"
#include "armature/recording/mcap_summary.hpp"

namespace armature {
namespace {

constexpr std::string_view kVolumeSchema = "armature_msgs/msg/VolumeFile";

bool is_volume(const McapChannel& channel, const std::map<std::uint16_t, McapSchema>& schemas) {
  const auto schema = schemas.find(channel.schema_id);
  return schema != schemas.end() && schema->second.name == kVolumeSchema;
}

/// As its summary says; one without a summary is read to find out.
bool has_volumes(const std::filesystem::path& recording) {
  const auto summary = read_summary(recording);
  return !summary || std::ranges::any_of(summary->channels, [&](const auto& entry) {
    return is_volume(entry.second, summary->schemas);
  });
}

}  // namespace

std::map<std::string, std::string> lost_volumes(const std::filesystem::path& recording) {
  std::map<std::string, std::string> lost;
  if (!has_volumes(recording)) return lost;
  std::set<std::tuple<std::string, std::string, std::string>> seen;  // topic, path, hash
  McapReader reader{recording};
  while (const auto message = reader.next()) {
    const McapChannel& channel = *message->channel;
    msg::VolumeFile file;
    if (!is_volume(channel, reader.schemas()) ||
        !message_type<msg::VolumeFile>().decode(message->data, &file) ||
        !seen.emplace(channel.topic, file.path_(), file.sha256_()).second) {
      continue;
    }
    if (const auto volume = volume_of(file); !volume) {
      lost.emplace(channel.topic,
                   fmt::format("it reads a volume, of which a recording holds path and SHA-256 "
                               "only, and {}; put back the one with {} (the parameter file of "
                               "sim/ct_head keeps it after the run)",
                               volume.error().text, file.sha256_()));
    }
  }
  return lost;
}

}  // namespace armature
