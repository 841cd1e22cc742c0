// Every law of the kind, on the arm in arm.urdf.
#include <cstdio>

#include "armature/config/problems.hpp"
#include "armature/kinds/ik/verify/plugin_subject.hpp"
#include "armature/robot/files/urdf_robot.hpp"

using namespace armature;

int main(int, char** argv) {
  PluginRegistry plugins;  // ctest sets ARMATURE_PLUGIN_PATH to where the plugin was built
  const PluginManifest* plugin = plugins.find("@ID@");
  if (!plugin) return std::puts(plugins.unknown_text("@ID@").c_str()), 1;
  config::Problems problems;
  const Params params = Params::read(plugin->params, nullptr, plugin->id, problems);
  const LinkName root, tool{"tool0", {}};
  const auto arm = std::make_shared<const RobotModel>(load_urdf_robot("arm.urdf", root, tool));
  IkSubject subject = plugin_subject(plugins, *plugin, arm, params).value();
  subject.poses = subject.edge_poses = 200;
  int broken = 0;
  for (const IkLaw& law : ik_laws()) {
    const LawReport report = check_law(law, subject);
    std::printf("%s: %d of %d answers break it\n", law.name.data(), report.failed, report.questions);
    for (const auto& [what, question] : report.violations) std::puts(what.c_str());
    broken += report.failed;
  }
  return broken == 0 ? 0 : 1;
}
