// SPDX-License-Identifier: Apache-2.0
// `armature schema` against files. python3-jsonschema judges, as editors do.
#pragma once

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "armature/values/temporary_folder.hpp"
#include "command.hpp"

namespace armature::test {

class JudgedBySchema : public testing::Test {
 protected:
  /// `of`: the sort of file; without, a deployment.
  explicit JudgedBySchema(const std::string& of = "") {
    std::vector<std::string> command{armature(), "schema"};
    if (!of.empty()) command.push_back(of);
    const auto result = run_command(command);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    schema_ = nlohmann::json::parse(result.out, nullptr, false);
    EXPECT_FALSE(schema_.is_discarded()) << result.out.substr(0, 1000);
    std::ofstream{folder_ / "schema.json"} << result.out;
  }

  /// What the schema says against files, a line for each thing; empty: nothing.
  std::string judged(const std::vector<std::string>& files) const {
    // The python of the system has its packages.
    std::vector<std::string> command{"/usr/bin/python3",
                                     source_file("tests/command_line/judge_by_schema.py"),
                                     folder_ / "schema.json"};
    command.insert(command.end(), files.begin(), files.end());
    const auto result = run_command(command);
    EXPECT_EQ(result.err, "");
    EXPECT_EQ(result.exit_code, result.out.empty() ? 0 : 1) << result.err;
    return result.out;
  }

  /// The same of the files of a folder of this project, of which there are at least `least`.
  void expect_fits_all_in(const std::string& folder, std::size_t least) const {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator{source_file(folder)}) {
      if (entry.path().extension() == ".yaml") files.push_back(entry.path());
    }
    ASSERT_GE(files.size(), least);
    EXPECT_EQ(judged(files), "");
  }

  std::string written(const std::string& yaml, std::size_t number = 0) const {
    const std::string file = folder_ / ("file_" + std::to_string(number) + ".yaml");
    std::ofstream{file} << yaml;
    return file;
  }

  std::string judged_text(const std::string& yaml) const { return judged({written(yaml)}); }

  /// Each text is refused for what stands beside it.
  void expect_refused(const std::vector<std::pair<std::string, std::string>>& wrong) const {
    std::vector<std::string> files;
    for (const auto& [text, said] : wrong) files.push_back(written(text, files.size()));
    const std::string all = judged(files);
    for (std::size_t i = 0; i < files.size(); ++i) {
      const std::size_t at = all.find(files[i]);
      ASSERT_NE(at, std::string::npos) << wrong[i].first << " is taken";
      EXPECT_THAT(all.substr(at, all.find('\n', at) - at), testing::HasSubstr(wrong[i].second));
    }
  }

  const TemporaryFolder folder_;
  nlohmann::json schema_;
};

}  // namespace armature::test
