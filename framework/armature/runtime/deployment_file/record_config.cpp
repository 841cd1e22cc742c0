// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/deployment_file/record_config.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <ctime>

#include "armature/config/document.hpp"
#include "armature/config/reader.hpp"
#include "armature/runtime/deployment_file/deployment_config.hpp"
#include "armature/runtime/deployment_file/deployment_keys.hpp"

namespace armature {

std::filesystem::path RecordConfig::file_of(std::string_view process, Time start) const {
  const std::time_t second = start.ns / 1'000'000'000;
  tm utc{};  // of which no hour comes twice
  gmtime_r(&second, &utc);
  std::array<char, 4096> name{};
  const std::size_t size = std::strftime(name.data(), name.size(), file.c_str(), &utc);
  // The folder comes last: a '%' in it says no time.
  return part_of(config::folder_of(origin) / std::string_view{name.data(), size}, process);
}

std::filesystem::path RecordConfig::part_of(std::filesystem::path main_file,
                                            std::string_view process) {
  if (process == kMainProcess) return main_file;
  const std::string extension = main_file.extension();
  return main_file.replace_extension(fmt::format("{}{}", process, extension));
}

RecordConfig read_record(const config::Node& section, config::Problems& problems) {
  RecordConfig record;
  config::MapReader map{section, "record", record_keys(), problems};
  const std::string file = map.text("file");
  const config::Node* named = section.find("file");
  record.origin = named ? named->origin() : section.origin();
  record.file = file;
  if (!file.empty() && record.file.extension() != ".mcap") {
    map.problem("file", fmt::format("{} is no name of a recording: they end in .mcap",
                                    config::in_quotes(file)));
  }
  record.topics = map.optional_texts("topics").value_or(std::vector<std::string>{});
  record.compress = map.flag("compress");
  record.thin = map.flag("thin");
  if (const auto around = map.optional_number("around_faults_s")) {
    record.around_faults = seconds(*around);
    if (file.find('%') == std::string::npos) {
      map.problem("file", fmt::format("{} would be written once: with 'around_faults_s' the name "
                                      "must say the time, fault-%Y%m%d-%H%M%S.mcap",
                                      config::in_quotes(file)));
    }
  }
  map.finish();
  return record;
}

void check_record(const RecordConfig& record, const config::Node& section,
                  const std::string& deployment, const std::vector<ComponentConfig>& components,
                  config::Problems& problems) {
  // The runtime writes some itself, in every process.
  std::vector<std::string> topics{"/rosout", "/diagnostics", "/clock"};
  for (const char* own : {"component_states", "description"}) {
    topics.push_back(fmt::format("/{}/{}", deployment, own));
  }
  for (const ComponentConfig& component : components) {
    for (const auto* ports : {&component.inputs, &component.outputs}) {
      for (const PortBinding& port : *ports) topics.push_back(port.topic);
    }
  }
  const config::Node* list = section.find("topics");
  for (const std::string& wanted : record.topics) {
    const auto is_meant = [&](const std::string& topic) { return matches_topic(wanted, topic); };
    if (std::ranges::any_of(topics, is_meant)) continue;
    problems.add(list->origin(),
                 fmt::format("'record' names the topic {}, which no component writes or reads{}",
                             config::in_quotes(wanted), config::did_you_mean(wanted, topics)));
  }
}

bool matches_topic(std::string_view pattern, std::string_view topic) {
  return pattern.ends_with('*') ? topic.starts_with(pattern.substr(0, pattern.size() - 1))
                                : topic == pattern;
}

}  // namespace armature
