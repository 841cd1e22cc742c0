// SPDX-License-Identifier: Apache-2.0
// A file of another sort in the place of a deployment or a robot, a folder that is not there, and
// an arm that was forgotten: each is told as what it is, with the way out.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "armature/values/temporary_folder.hpp"
#include "command.hpp"
#include "tests/text.hpp"

namespace armature::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class WrongFile : public testing::Test {
 protected:
  std::string written(const std::string& name, const std::string& text) const {
    std::ofstream{folder_ / name} << text;
    return (folder_ / name).string();
  }
  static std::string refusal(const std::vector<std::string>& arguments) {
    std::vector<std::string> all{armature()};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const auto result = run_command(all);
    EXPECT_EQ(result.exit_code, 3) << result.err;
    return result.err;
  }
  const TemporaryFolder folder_;
};

TEST_F(WrongFile, ARobotFileIsNoDeployment) {
  EXPECT_THAT(refusal({"check", source_file("configs/robots/dental_lamp.yaml")}),
              HasSubstr("not a deployment but a robot file, which a deployment names under "
                        "'robots:': it must begin with 'armature: 1'"));
}

TEST_F(WrongFile, AUrdfFileIsNamedInARobotFile) {
  EXPECT_THAT(refusal({"check", source_file("configs/robots/arm.urdf")}),
              HasSubstr(":1:1: an XML file, not YAML; a URDF file is named in a robot file, 'urdf: "
                        "arm.urdf'"));
}

TEST_F(WrongFile, AXacroFileIsToBeRunFirst) {
  const std::string text = "<robot name='a' xmlns:xacro='x'><xacro:include filename='b'/></robot>";
  const std::string xacro = written("arm.urdf.xacro", text), urdf = written("arm.urdf", text);
  EXPECT_THAT(refusal({"fk", "--robot", xacro, "--tip", "x"}),
              HasSubstr("a xacro file, not YAML: run 'xacro FILE > arm.urdf'"));
  EXPECT_EQ(refusal({"fk", "--robot", urdf, "--tip", "x"}),
            urdf + ": a xacro file: run 'xacro " + urdf + " > arm.urdf', and name that\n");
}

TEST_F(WrongFile, APluginFolderThatIsNotThereIsSaid) {
  const Command::Options environment{
      .environment = {{"ARMATURE_PLUGIN_PATH", (folder_ / "none").string()}}, .input = {}};
  const auto result = run_command({armature(), "plugin", "list"}, environment);
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("plugin folder " + (folder_ / "none").string() +
                                    ": there is no such folder"));
}

TEST_F(WrongFile, AForgottenArmIsAskedFor) {
  std::string text =
      all_replaced(text_of(source_file("configs/dental_lamp.yaml")), "\n  arm: [^\n]*", "");
  text = all_replaced(text, "(robots|rigs)/", source_file("configs") + "/$1/");
  EXPECT_THAT(refusal({"check", written("lamp.yaml", text)}),
              HasSubstr("motion.measured_js reads topic '/dental_lamp/arm/measured_js', which "
                        "nobody writes; add a component that does: arm/simulated\n"));
}

}  // namespace
}  // namespace armature::test
