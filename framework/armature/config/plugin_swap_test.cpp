// SPDX-License-Identifier: Apache-2.0
// Another plugin in the place of one: by an overlay, and by one word of the command line.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "armature/config/document.hpp"
#include "armature/values/temporary_folder.hpp"

namespace armature::config {
namespace {

/// A file with a solver that has two parameters.
class PluginSwap : public testing::Test {
 protected:
  PluginSwap() {
    std::ofstream{file_} << "m:\n  ik: {plugin: ik/a, executor: fast, params: {x: 1, y: 2}}\n";
  }

  /// What stands there after the assignments.
  std::string after(const std::vector<std::string>& assignments,
                    std::vector<std::string>* notes = nullptr) const {
    return to_yaml(load_with_overlays({file_}, assignments, notes), false);
  }
  std::string below(const std::string& overlay) const {
    return to_yaml(merge(load(file_), parse_text(overlay, "overlay.yaml")), false);
  }
  static std::string ik(const std::string& plugin, const std::string& params) {
    return "m:\n  ik:\n    plugin: " + plugin + "\n    executor: fast\n" + params;
  }

  const TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "swap.yaml";
};

TEST_F(PluginSwap, AnOverlayWithAnotherPluginBringsItsOwnParameters) {
  const std::string own = "    params:\n      y: 3\n      z: 4\n";
  const std::string other = "{plugin: ik/b, params: {y: 3, z: 4}}";
  EXPECT_EQ(below("m: {ik: " + other + "}"), ik("ik/b", own));
  EXPECT_EQ(after({"m.ik=" + other}), ik("ik/b", own));
  EXPECT_EQ(below("m: {ik: {plugin: ik/b}}"), ik("ik/b", "    params: {}\n"));
  EXPECT_EQ(below("m: {ik: {plugin: ik/b, params: null}}"), ik("ik/b", ""));
}

TEST_F(PluginSwap, AnOverlayWithTheSamePluginIsMerged) {
  const std::string both = "    params:\n      x: 1\n      y: 3\n";
  EXPECT_EQ(below("m: {ik: {plugin: ik/a, params: {y: 3}}}"), ik("ik/a", both));
  EXPECT_EQ(below("m: {ik: {params: {y: 3}}}"), ik("ik/a", both));
}

TEST_F(PluginSwap, OneWordTellsWhatItLeavesOut) {
  std::vector<std::string> notes;
  EXPECT_EQ(after({"m.ik.plugin=ik/a"}, &notes),
            ik("ik/a", "    params:\n      x: 1\n      y: 2\n"));
  EXPECT_TRUE(notes.empty()) << notes.front();
  EXPECT_EQ(after({"m.ik.plugin=ik/b"}, &notes), ik("ik/b", "    params: {}\n"));
  EXPECT_EQ(notes, std::vector<std::string>{
                       "--set m.ik.plugin=ik/b: left out what was written for 'ik/a': x, y; give "
                       "what is meant for 'ik/b' as well with --set m.ik.params.NAME=VALUE"});
}

TEST_F(PluginSwap, WhatTheCommandLineSaysOfParametersStaysInAnyOrder) {
  const std::string said = ik("ik/b", "    params:\n      x: 5\n");
  EXPECT_EQ(after({"m.ik.plugin=ik/b", "m.ik.params.x=5"}), said);
  EXPECT_EQ(after({"m.ik.params.x=5", "m.ik.plugin=ik/b"}), said);
  EXPECT_EQ(after({"m.ik.plugin=ik/b", "m.ik.params=null"}), ik("ik/b", ""));
}

}  // namespace
}  // namespace armature::config
