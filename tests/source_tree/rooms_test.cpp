// SPDX-License-Identifier: Apache-2.0
// A room is a folder with sources. 1. No two rooms of the framework stand on each other, also not
// by way of others. 2. The layers stand in their order. 3. A plugin knows the framework, what
// plugins share in plugins/common, and no other plugin. Tests, and the glue of GoogleTest
// (contract.hpp), may look everywhere.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/text.hpp"

namespace armature::test {
namespace {

namespace fs = std::filesystem;

const fs::path kFramework = fs::path{ARMATURE_SOURCE_DIR} / "framework";

bool is_product_source(const fs::path& file) {
  const std::string name = file.filename();
  return (name.ends_with(".hpp") || name.ends_with(".cpp")) && !name.ends_with("_test.cpp") &&
         !name.ends_with("_test.hpp") && name != "contract.hpp";
}

std::vector<fs::path> product_sources(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator{folder}) {
    if (entry.is_regular_file() && is_product_source(entry.path())) files.push_back(entry.path());
  }
  return files;
}

/// What a file includes in quotation marks: "armature/robot/model/robot_model.hpp".
std::vector<std::string> included(const fs::path& file) {
  std::vector<std::string> names;
  for (const auto& match : matches_of("#include \"([^\"]+)\"", text_of(file))) {
    names.push_back(match[1]);
  }
  return names;
}

/// The rooms that each room stands on: "armature/robot/files" on {"armature/robot/model", ...}.
using Rooms = std::map<std::string, std::set<std::string>>;

Rooms rooms_of_framework() {
  Rooms rooms;
  for (const fs::path& file : product_sources(kFramework)) {
    const std::string room = fs::relative(file.parent_path(), kFramework);
    for (const std::string& name : included(file)) {
      const std::string other = fs::path{name}.parent_path();
      if (other != room && name.starts_with("armature/")) rooms[room].insert(other);
    }
  }
  return rooms;
}

/// "values" of "armature/values".
std::string layer_of(const std::string& room) {
  const auto begin = room.find('/') + 1;
  return room.substr(begin, room.find('/', begin) - begin);
}

TEST(Rooms, NeverStandOnEachOther) {
  const Rooms rooms = rooms_of_framework();
  ASSERT_GT(rooms.size(), 20U);
  for (const auto& [room, others] : rooms) {
    std::set<std::string> below;
    const std::function<void(const std::string&)> descend = [&](const std::string& at) {
      if (!rooms.contains(at)) return;
      for (const std::string& next : rooms.at(at)) {
        if (below.insert(next).second) descend(next);
      }
    };
    descend(room);
    EXPECT_FALSE(below.contains(room)) << room << " stands on rooms that stand on it";
  }
}

TEST(Rooms, OfALayerStandOnLayersBelowIt) {
  constexpr std::array<std::string_view, 16> kOrder{
      "values",    "laws", "plot",    "config", "volume", "robot",       "scene",  "messages",
      "recording", "bus",  "runtime", "web",    "kinds",  "calibration", "motion", "task"};
  const auto place = [&](const std::string& room) {
    const auto found = std::ranges::find(kOrder, layer_of(room));
    EXPECT_NE(found, kOrder.end()) << "the layer of " << room << " has no place in the order";
    return found - kOrder.begin();
  };
  for (const auto& [room, others] : rooms_of_framework()) {
    for (const std::string& other : others) {
      EXPECT_GE(place(room), place(other)) << room << " includes headers of " << other;
    }
  }
}

TEST(Plugins, KnowTheFrameworkAndNoOtherPlugin) {
  const fs::path plugins = fs::path{ARMATURE_SOURCE_DIR} / "plugins";
  const std::vector<fs::path> sources = product_sources(plugins);
  ASSERT_GT(sources.size(), 100U);
  for (const fs::path& source : sources) {
    for (const std::string& name : included(source)) {
      const bool of_the_framework = fs::exists(kFramework / name);
      const bool shared = name.starts_with("plugins/common/");
      const bool of_a_plugin = name.find('/') != std::string::npos && fs::exists(plugins / name);
      const bool whole_path = name.starts_with("plugins/") && !shared;
      const bool climbs = name.find("..") != std::string::npos;
      EXPECT_FALSE(!of_the_framework && (of_a_plugin || whole_path || climbs))
          << source << " includes " << name;
    }
  }
}

}  // namespace
}  // namespace armature::test
