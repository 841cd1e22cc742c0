// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "armature/config/document.hpp"
#include "armature/kinds/component/laws.hpp"
#include "plugin_laws.hpp"

namespace armature {
namespace {

class ComponentLawsOfPlugin final : public PluginLaws {
 public:
  explicit ComponentLawsOfPlugin(const VerifiedPlugin& verified)
      : plugins_{verified.search_path}, plugin_{*plugins_.find(verified.id)} {
    const std::string& params = verified.options.params;
    bench_.component =
        fmt::format("{{plugin: {}, params: {}}}", plugin_.id, params.empty() ? "{}" : params);
    if (!verified.arm.robot.empty()) bench_.robot = config::load(verified.arm.robot);
    if (!verified.options.rig.empty()) bench_.rig = config::load(verified.options.rig);
    seed_ = verified.options.seed;
    rounds_ = verified.options.poses;
  }

  std::string refusal() override { return refusal_of(plugins_, bench_); }
  std::vector<LawRun> laws() override {
    std::vector<LawRun> runs = laws_of_unit(std::string{kMainUnit}, "");
    for (const UnitSpec& unit : plugin_.units) {
      for (LawRun& run : laws_of_unit(unit.name, unit.name + ": ")) runs.push_back(std::move(run));
    }
    return runs;
  }

 private:
  std::vector<LawRun> laws_of_unit(const std::string& unit, const std::string& prefix) {
    ComponentHarness::Options options = bench_;
    options.unit = unit;
    const ComponentSubject subject{
        .name = plugin_.id,
        .make = [this, options] { return std::make_unique<ComponentHarness>(plugins_, options); },
        .seed = seed_,
        .rounds = rounds_};
    std::vector<LawRun> runs;
    for (const Law<ComponentSubject>& law : component_laws()) {
      runs.push_back(
          {prefix + std::string{law.says}, [subject, &law] { return check_law(law, subject); }});
    }
    return runs;
  }

  PluginRegistry plugins_;
  const PluginManifest& plugin_;
  ComponentHarness::Options bench_;
  std::uint64_t seed_ = 1;
  int rounds_ = 0;
};

}  // namespace

std::unique_ptr<PluginLaws> laws_of_component(const VerifiedPlugin& verified) {
  return std::make_unique<ComponentLawsOfPlugin>(verified);
}

}  // namespace armature
