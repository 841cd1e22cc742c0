// SPDX-License-Identifier: Apache-2.0
// `armature plugin new` of every family: what it writes builds outside this tree, keeps the laws of
// its kind, and runs in the deployment that it brings or names.
#include "tests/new_plugins.hpp"

#include <gmock/gmock.h>

#include "tests/dds_domain.hpp"

namespace armature::test {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;

TEST(NewPlugins, OfEveryFamilyBuildKeepTheLawsAndRunTogether) {
  const NewPlugins plugins{ARMATURE_BINARY_DIR "/tests/new_plugins"};
  EXPECT_EQ(plugins.families().size(), 15U);
  plugins.write();
  plugins.build(true);
  if (HasFatalFailure()) return;
  plugins.expect_laws_kept();

  const auto run = [&](const std::vector<std::string>& more) {
    std::vector<std::string> command{armature(), "run", "--domain",
                                     std::to_string(unique_dds_domain())};
    command.insert(command.end(), more.begin(), more.end());
    const auto result = run_command(command, plugins.environment(), std::chrono::seconds{120});
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    return result.out;
  };
  std::vector<std::string> lamp{"dental_lamp", plugins.folder("monitor") / "overlay.yaml",
                                plugins.folder("component") / "overlay.yaml", "--set",
                                "clock=simulated"};
  for (const auto& [family, place] :
       std::vector<std::pair<std::string, std::string>>{{"detector", "landmarks.detector"},
                                                        {"landmarks", "landmarks"},
                                                        {"face_pose", "face"},
                                                        {"target", "target"},
                                                        {"path", "motion.path"},
                                                        {"ik", "motion.ik"},
                                                        {"select", "motion.select"},
                                                        {"trajectory", "motion.trajectory"},
                                                        {"arm", "arm"}}) {
    lamp.insert(lamp.end(), {"--set", "components." + place + ".plugin=" + NewPlugins::id(family)});
  }
  const std::string lamp_told = run(lamp);
  EXPECT_THAT(lamp_told, HasSubstr("top speed of the tool"));
  EXPECT_THAT(lamp_told, HasSubstr("greatest joint speed"));
  run({"sr1_biopsy", "--set", "components.registration.plugin=registration/my_registration"});
  run({"sr1_from_images", "--set", "components.markers.plugin=markers/my_markers"});
  run({plugins.folder("task") / "tour.yaml"});
  run({plugins.folder("arm") / "tour.yaml", "--set", "clock=simulated"});
  EXPECT_THAT(run({plugins.folder("camera") / "camera.yaml"}),
              ContainsRegex("pictures lost +0 +goal 0  met"));
}

}  // namespace
}  // namespace armature::test
