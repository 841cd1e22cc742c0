// SPDX-License-Identifier: Apache-2.0
// Nobody can forget the ABI tag: it is made of the tokens of the headers themselves.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "armature/runtime/plugins/abi.hpp"
#include "armature/values/temporary_folder.hpp"
#include "command.hpp"
#include "tests/text.hpp"

namespace armature::test {
namespace {

namespace fs = std::filesystem;

std::string with_every(const std::string& text, const std::string& pattern, const std::string& by) {
  const std::string changed = all_replaced(text, pattern, by);
  EXPECT_NE(changed, text) << pattern;
  return changed;
}

/// A folder with a copy of a header, and the tags of two libraries: `ik`, which has it, and `path`.
class HeaderTags : public testing::Test {
 protected:
  HeaderTags() {
    write("libraries.cmake",
          "set(libraries \"abi;path;ik;select\")\n"
          "set(abi_headers \"" +
              source_file("framework/armature/values/expected.hpp") +
              "\")\n"
              "set(path_headers \"" +
              source_file("framework/armature/kinds/path/path.hpp") +
              "\")\n"
              "set(ik_headers \"" +
              (folder_ / "ik.hpp").string() +
              "\")\n"
              "set(select_headers \"\")\nset(select_links \"ik\")\n");
  }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream{folder_ / name} << text;
  }
  /// The tag of each library when the header of `ik` is this.
  std::map<std::string, std::string> tags_with(const std::string& header) const {
    write("ik.hpp", header);
    const fs::path written = folder_ / "header_tags.hpp";
    const auto result = run_command(
        {CMAKE_PROGRAM, "-D", "LIBRARIES=" + (folder_ / "libraries.cmake").string(), "-D",
         "OUTPUT=" + written.string(), "-P", source_file("cmake/header_tags.cmake")});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const std::string text = text_of(written);
    std::map<std::string, std::string> tags;
    for (const auto& line :
         matches_of("#define ARMATURE_HEADERS_(\\w+) \"\\1 ([0-9a-f]{12})\"", text)) {
      tags[line[1]] = line[2];
    }
    EXPECT_EQ(tags.size(), 4u) << text;
    return tags;
  }

  std::string with_another_virtual_function() const {
    return with_every(header_, "virtual IkStatus solve",
                      "virtual int more() const;\n  virtual IkStatus solve");
  }

  const std::string header_ = text_of(source_file("framework/armature/kinds/ik/ik.hpp"));
  const TemporaryFolder folder_;
};

TEST_F(HeaderTags, CommentsAndBlanksDoNotCount) {
  const auto before = tags_with(header_);
  EXPECT_EQ(tags_with(with_every(header_, "//[^\n]*", "// another")), before);
  EXPECT_EQ(tags_with(with_every(header_, "[{]\n", "{\n\n  /* more\n * lines **/\n")), before);
}

TEST_F(HeaderTags, AVirtualFunctionChangesThoseOfTheLibraryAndOfWhatStandsOnIt) {
  const auto before = tags_with(header_);
  const auto after = tags_with(with_another_virtual_function());
  EXPECT_NE(after.at("ik"), before.at("ik"));
  EXPECT_NE(after.at("select"), before.at("select"));
  EXPECT_EQ(after.at("path"), before.at("path"));
  EXPECT_EQ(after.at("abi"), before.at("abi"));
}

TEST_F(HeaderTags, WordsThatGrowTogetherCount) {
  EXPECT_NE(tags_with("int a; unsigned b;").at("ik"), tags_with("inta; unsigned b;").at("ik"));
}

TEST_F(HeaderTags, APluginOfOtherHeadersIsRefusedWithBothTags) {
  const std::string tag = "ik " + tags_with(with_another_virtual_function()).at("ik");
  write("solver.c",
        "__attribute__((section(\".armature.manifest\"), used)) static const char manifest[] =\n"
        "    \"armature_plugin: 1\\nid: ik/changed\\nkind: ik\\ndoc: Other headers.\\n\";\n"
        "__attribute__((section(\".armature.abi\"), used)) static const char abi[] =\n"
        "    \"" ARMATURE_ABI_TAG ", " +
            tag + "\";\n");
  const auto compiled =
      run_command({C_COMPILER, "-shared", folder_ / "solver.c", "-o", folder_ / "changed.so"});
  ASSERT_EQ(compiled.exit_code, 0) << compiled.err;
  const auto result =
      run_command({armature(), "ik", "--robot", source_file("configs/robots/dental_lamp.yaml"),
                   "--plugin", "ik/changed"},
                  {.environment = {{"ARMATURE_PLUGIN_PATH", folder_.path()}}, .input = {}});
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_EQ(result.err, "armature: plugin 'ik/changed' cannot be used: " +
                            (folder_ / "changed.so").string() + ": built for [" + tag +
                            "], this is [" ARMATURE_HEADERS_ik "]; rebuild the plugin\n");
}

TEST(AbiOfAPlugin, SettingsThatChangeTheLayoutOfSharedObjectsDoNotCompile) {
  const TemporaryFolder folder;
  const std::string file = folder / "plugin.cpp";
  std::ofstream{file} << "#include \"armature/runtime/plugins/abi.hpp\"\n";
  const auto said_with = [&](const std::string& flag) {
    return run_command({CXX_COMPILER, "-std=c++20", "-fsyntax-only", flag,
                        "-I" + source_file("framework"), "-I" ARMATURE_BINARY_DIR "/generated",
                        "-DARMATURE_EXPORT=", file})
        .err;
  };
  EXPECT_EQ(said_with("-O2"), "");
  EXPECT_EQ(said_with("-DEIGEN_DEFAULT_DENSE_INDEX_TYPE=long"), "");
  for (const char* flag : {"-DEIGEN_DEFAULT_DENSE_INDEX_TYPE=int", "-DEIGEN_DEFAULT_TO_ROW_MAJOR",
                           "-fpack-struct=4"}) {
    EXPECT_NE(said_with(flag).find("error: "), std::string::npos) << flag;
    EXPECT_NE(said_with(flag).find("Armature's "), std::string::npos) << flag;
  }
}

}  // namespace
}  // namespace armature::test
