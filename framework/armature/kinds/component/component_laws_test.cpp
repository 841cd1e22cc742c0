// SPDX-License-Identifier: Apache-2.0
// The laws of components bite: each of these components breaks one of them.
#include <gtest/gtest.h>

#include <cmath>

#include "armature/kinds/component/laws.hpp"
#include "armature/messages/sensor_msgs.hpp"

namespace armature {
namespace {

constexpr const char* kManifest = R"(
armature_plugin: 1
id: test/faulty
kind: component
params:
  fault: {type: text, default: "none", doc: "Which law it breaks"}
in:
  arm: {type: sensor_msgs/JointState, reads: queue(4), trigger: true, doc: "An arm"}
out:
  told: {type: sensor_msgs/JointState, doc: "The same"}
)";

class Faulty final : public Component {
 public:
  explicit Faulty(Setup& setup)
      : Component{setup},
        fault_{setup.params().text("fault")},
        arm_{setup.input<msg::JointState>("arm")} {
    if (fault_ != "ports") setup.output<msg::JointState>("told");
    static bool was_made = false;
    if (fault_ == "again" && was_made) throw std::runtime_error("the device is still open");
    was_made = was_made || fault_ == "again";
    setup.activate_every(seconds(0.1));
  }
  void step(Time) override {
    if (fault_ == "silence" && arm_.size() == 0) throw std::runtime_error("nobody is there");
    for (std::size_t i = 0; i < arm_.size(); ++i) look_at(arm_[i]);
  }
  bool stopped() const override { return fault_ != "stop"; }

 private:
  void look_at(const msg::JointState& arm) const {
    const auto& q = arm.position_();
    if (fault_ == "empty" && q.empty()) throw std::out_of_range("position 0 of 0");
    for (const double angle : q) {
      if (fault_ == "nan" && std::isnan(angle)) throw std::domain_error("NaN");
      if (fault_ == "chance" && angle > 1.5) throw std::domain_error("angle of more than 1.5");
    }
  }

  std::string fault_;
  Input<msg::JointState> arm_;
};

/// The laws that a component with this fault breaks.
std::vector<std::string> broken_by(const std::string& fault) {
  PluginRegistry plugins{std::vector<std::filesystem::path>{}};
  plugins.add<Faulty>(kManifest);
  const ComponentSubject subject{
      .name = fault, .make = [&] {
        const std::string component = "{plugin: test/faulty, params: {fault: " + fault + "}}";
        return std::make_unique<ComponentHarness>(
            plugins, ComponentHarness::Options{.component = component, .robot = {}});
      }};
  std::vector<std::string> broken;
  for (const Law<ComponentSubject>& law : component_laws()) {
    if (!check_law(law, subject).kept()) broken.emplace_back(law.name);
  }
  return broken;
}

using Names = std::vector<std::string>;

TEST(ComponentLaws, AComponentWithoutFaultKeepsAll) { EXPECT_EQ(broken_by("none"), Names{}); }

TEST(ComponentLaws, APortThatIsNotClaimedBreaksEveryLaw) {
  EXPECT_EQ(broken_by("ports").size(), component_laws().size());
}

TEST(ComponentLaws, AnExceptionIsFoundByTheLawOfWhatCausedIt) {
  EXPECT_EQ(broken_by("empty").at(0), "EmptyMessagesAreNoFault");
  EXPECT_EQ(broken_by("nan").at(0), "NumbersThatAreNoneAreNoFault");
  EXPECT_EQ(broken_by("chance"), Names{"MessagesByChanceAreNoFault"});
  EXPECT_EQ(broken_by("silence").at(0), "SilenceIsNoFault");
}

TEST(ComponentLaws, AComponentThatNeverRestsIsFound) {
  EXPECT_EQ(broken_by("stop"), Names{"AStopIsAnsweredWithRest"});
}

TEST(ComponentLaws, AComponentThatCannotBeMadeTwiceIsFound) {
  const Names broken = broken_by("again");
  EXPECT_EQ(broken.back(), "IsMadeAgainAfterItEnded");
}

}  // namespace
}  // namespace armature
