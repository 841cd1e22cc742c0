// SPDX-License-Identifier: Apache-2.0
// A parameter that a plugin.yaml declares is read: the code of the plugin names its member, or what
// the plugin requires and provides depends on it (`when`).
#include <gtest/gtest.h>

#include <filesystem>

#include "armature/config/document.hpp"
#include "armature/config/parameters/parameters_struct.hpp"
#include "tests/text.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;

/// The text of all sources in `folder` that are no tests.
std::string code_in(const fs::path& folder) {
  std::string code;
  for (const auto& entry : fs::directory_iterator{folder}) {
    const std::string name = entry.path().filename();
    const bool is_source = name.ends_with(".cpp") || name.ends_with(".hpp");
    if (is_source && name.find("_test.") == std::string::npos) code += test::text_of(entry.path());
  }
  return code;
}

/// Whether something that the plugin requires or provides depends on the parameter.
bool decides_a_trait(const config::Node& manifest, const std::string& parameter) {
  for (const char* key : {"requires", "provides"}) {
    const config::Node* traits = manifest.find(key);
    if (!traits) continue;
    for (const auto& trait : traits->entries()) {
      const config::Node* when = trait.value.find("when");
      if (when && when->text() == parameter) return true;
    }
  }
  return false;
}

std::vector<std::string> members_of(const config::Node& manifest) {
  config::Problems problems;
  const config::Node* table = manifest.find("params");
  const auto specs = table ? read_param_specs(*table, problems) : std::vector<ParamSpec>{};
  problems.throw_if_any();
  return parameter_members(specs);
}

TEST(AParameterThatIsDeclared, IsRead) {
  int declared = 0;
  for (const char* room : {"framework", "plugins"}) {
    for (const auto& entry :
         fs::recursive_directory_iterator{fs::path{ARMATURE_SOURCE_DIR} / room}) {
      if (entry.path().filename() != "plugin.yaml") continue;
      const std::string code = code_in(entry.path().parent_path());
      const config::Node manifest = config::parse_file(entry.path());
      for (const std::string& member : members_of(manifest)) {
        ++declared;
        if (decides_a_trait(manifest, member)) continue;
        EXPECT_FALSE(test::matches_of("(\\.|->)" + member + "\\b", code).empty())
            << entry.path().string() << " declares what becomes the member '" << member
            << "', and no file beside it reads that";
      }
    }
  }
  EXPECT_GT(declared, 200);
}

}  // namespace
}  // namespace armature
