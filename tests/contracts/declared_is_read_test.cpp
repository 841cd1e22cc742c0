// SPDX-License-Identifier: Apache-2.0
// What a plugin.yaml declares is used. A parameter is read: the code of the plugin names its
// member, or what the plugin requires and provides depends on it (`when`). A port is read or
// written: the code names its member of `struct Ports`, or claims it by name. The laws of
// components do not see this, since the struct claims every port.
#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

#include "armature/config/document.hpp"
#include "armature/config/parameters/cpp_name.hpp"
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

std::vector<fs::path> manifests_of_this_tree() {
  std::vector<fs::path> files;
  for (const char* room : {"framework", "plugins"}) {
    for (const auto& entry :
         fs::recursive_directory_iterator{fs::path{ARMATURE_SOURCE_DIR} / room}) {
      if (entry.path().filename() == "plugin.yaml") files.push_back(entry.path());
    }
  }
  return files;
}

/// The inputs and outputs of a component, as plugin.yaml names them.
std::vector<std::string> ports_of(const config::Node& manifest) {
  std::vector<std::string> ports;
  for (const char* direction : {"in", "out"}) {
    const config::Node* table = manifest.find(direction);
    if (!table) continue;
    for (const auto& port : table->entries()) ports.push_back(port.key);
  }
  return ports;
}

bool uses_port(const std::string& port, const std::string& code) {
  const std::string member = "\\bports_?\\." + in_cpp(port) + "\\b";
  const std::string claim = "\\b(input|input_if|output)<[^()]*>\\(\"" + port + "\"\\)";
  return !test::matches_of(member + "|" + claim, code).empty();
}

TEST(AParameterThatIsDeclared, IsRead) {
  int declared = 0;
  for (const fs::path& file : manifests_of_this_tree()) {
    const std::string code = code_in(file.parent_path());
    const config::Node manifest = config::parse_file(file);
    for (const std::string& member : members_of(manifest)) {
      ++declared;
      if (decides_a_trait(manifest, member)) continue;
      EXPECT_FALSE(test::matches_of("(\\.|->)" + member + "\\b", code).empty())
          << file.string() << " declares what becomes the member '" << member
          << "', and no file beside it reads that";
    }
  }
  EXPECT_GT(declared, 200);
}

TEST(APortThatIsDeclared, IsReadOrWritten) {
  int declared = 0;
  for (const fs::path& file : manifests_of_this_tree()) {
    const std::string code = code_in(file.parent_path());
    if (code.find("_ports.hpp\"") == std::string::npos) continue;  // RequestHost claims them
    for (const std::string& port : ports_of(config::parse_file(file))) {
      ++declared;
      EXPECT_TRUE(uses_port(port, code)) << file.string() << " declares the port '" << port
                                         << "', and no file beside it reads or writes that";
    }
  }
  EXPECT_GT(declared, 200);
}

}  // namespace
}  // namespace armature
