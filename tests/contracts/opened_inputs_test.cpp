// SPDX-License-Identifier: Apache-2.0
// Who may write the inputs of the deployments of configs/: what a deployment writes itself comes
// from itself, but for commands that anybody may give, and for what its file opens.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "armature/config/document.hpp"
#include "armature/runtime/deployment_file/deployment_config.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

DeploymentConfig deployment_of(const std::string& file, const std::vector<std::string>& settings) {
  static const PluginRegistry plugins{{ARMATURE_PLUGIN_BUILD_DIR}};
  config::Problems problems;
  DeploymentConfig read =
      read_deployment(config::load_with_overlays({file}, settings), plugins, problems);
  problems.throw_if_any();
  return read;
}

/// The inputs that programs outside may write although the deployment does, too.
Names opened(const std::string& file, const std::vector<std::string>& settings = {}) {
  const DeploymentConfig deployment = deployment_of(ARMATURE_SOURCE_DIR "/" + file, settings);
  Names written, names;
  for (const ComponentConfig& component : deployment.components) {
    for (const PortBinding& output : component.outputs) written.insert(output.topic);
  }
  for (const ComponentConfig& component : deployment.components) {
    for (const PortBinding& input : component.inputs) {
      if (!input.spec.outside || !written.contains(input.topic)) continue;
      names.insert(component.name + "." + input.spec.name);
    }
  }
  return names;
}

TEST(WhatADeploymentWritesItself, ComesFromNobodyElse) {
  int read = 0;
  for (const auto& entry : fs::directory_iterator{ARMATURE_SOURCE_DIR "/configs"}) {
    if (entry.path().extension() != ".yaml") continue;
    const std::string file = "configs/" + entry.path().filename().string();
    EXPECT_EQ(opened(file), Names{}) << file;
    ++read;
  }
  EXPECT_GT(read, 5);
}

TEST(WhatADeploymentWritesItself, ComesFromOthersWhereItsFileSaysSo) {
  EXPECT_EQ(opened("configs/sr1_biopsy.yaml", {"open=[registration.request]"}),
            Names{"registration.request"});
}

TEST(WhatADeploymentWritesItself, AndCommandsTooMayBeSaidByAnybodyWhereThePluginSaysSo) {
  EXPECT_EQ(opened("configs/sr1_biopsy.yaml",
                   {"clock=system",
                    "components.pedal={plugin: operator/pendant, params: {device: /dev/null}, out: "
                    "{hold_to_run: /stop}}"}),
            Names{"motion.stop"});
}

TEST(WhatNobodyInADeploymentWrites, ComesFromAnybodyWhereItsPluginSaysSo) {
  const DeploymentConfig alone =
      deployment_of(ARMATURE_SOURCE_DIR "/tests/end_to_end/solvers_alone.yaml", {});
  int requests = 0;
  for (const ComponentConfig& component : alone.components) {
    for (const PortBinding& input : component.inputs) {
      if (input.spec.name != "request") continue;
      EXPECT_TRUE(input.spec.outside) << component.name;
      ++requests;
    }
  }
  EXPECT_GE(requests, 4);
}

}  // namespace
}  // namespace armature
