// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/testing/component_harness.hpp"

#include <gtest/gtest.h>

#include "armature/messages/std_msgs.hpp"
#include "tests/refusal.hpp"

namespace armature {
namespace {

constexpr const char* kManifest = R"(
armature_plugin: 1
id: test/shout
kind: component
params:
  mark: {type: text, default: "!", doc: "What is added"}
in:
  heard: {type: std_msgs/String, reads: queue(4), trigger: true, doc: "Words"}
  quiet: {type: std_msgs/Bool, reads: latest, max_age_s: 1, doc: "Whether to be quiet"}
out:
  said: {type: std_msgs/String, doc: "The same, louder"}
)";

class Shout final : public Component {
 public:
  explicit Shout(Setup& setup)
      : Component{setup},
        mark_{setup.params().text("mark")},
        heard_{setup.input<msg::String>("heard")},
        quiet_{setup.input<msg::Bool>("quiet")},
        said_{setup.output<msg::String>("said")} {
    setup.activate_every(seconds(0.5));
  }
  void step(Time) override {
    if (quiet_.latest() && quiet_.latest()->data_()) return degraded("quiet");
    healthy();
    for (std::size_t i = 0; i < heard_.size(); ++i) {
      if (heard_[i].data_().empty()) throw std::runtime_error("there is nothing to say");
      auto louder = said_.loan();
      louder->data_() = heard_[i].data_() + mark_;
      louder.publish();
      log("said " + heard_[i].data_());
    }
  }

 private:
  std::string mark_;
  Input<msg::String> heard_;
  Input<msg::Bool> quiet_;
  Output<msg::String> said_;
};

/// Claims none of its ports.
class Silent final : public Component {
 public:
  using Component::Component;
  void step(Time) override {}
};

PluginRegistry with_shout() {
  PluginRegistry plugins{std::vector<std::filesystem::path>{}};
  plugins.add<Shout>(kManifest);
  return plugins;
}

msg::String text(const std::string& data) {
  msg::String message;
  message.data_(data);
  return message;
}

class ComponentBenchTest : public testing::Test {
 protected:
  PluginRegistry plugins_ = with_shout();
  ComponentHarness bench_{plugins_, {.component = "{plugin: test/shout}", .robot = {}}};
};

TEST_F(ComponentBenchTest, ShowsWhatWasSentAndGivesWhatWasPublishedOnce) {
  EXPECT_FALSE(bench_.triggered());
  bench_.send("heard", text("one"));
  bench_.send("heard", text("two"));
  EXPECT_TRUE(bench_.triggered());
  bench_.step(0.1);
  EXPECT_FALSE(bench_.triggered());
  const auto said = bench_.take<msg::String>("said");
  ASSERT_EQ(said.size(), 2u);
  EXPECT_EQ(said[0].data_(), "one!");
  EXPECT_EQ(said[1].data_(), "two!");
  EXPECT_TRUE(bench_.take<msg::String>("said").empty());
  EXPECT_EQ(bench_.lines(), (std::vector<std::string>{"said one", "said two"}));
  EXPECT_EQ(bench_.period(), seconds(0.5));
}

TEST_F(ComponentBenchTest, KeepsTheRulesOfThePorts) {
  msg::Bool yes;
  yes.data_(true);
  bench_.send("quiet", yes);
  EXPECT_FALSE(bench_.triggered());
  bench_.step(0.5);
  EXPECT_EQ(bench_.status().state, StatusReporter::State::degraded);
  EXPECT_EQ(bench_.status().reason, "quiet");
  bench_.step(1.5);  // which is too old by now
  EXPECT_EQ(bench_.status().state, StatusReporter::State::ok);
  for (const char* word : {"1", "2", "3", "4", "5", "6"}) bench_.send("heard", text(word));
  bench_.step(2);
  EXPECT_EQ(bench_.take<msg::String>("said").size(), 4u) << "its queue is no longer";
}

TEST_F(ComponentBenchTest, ThrowsWhatTheComponentThrows) {
  bench_.send("heard", text(""));
  EXPECT_EQ(test::refusal_of([&] { bench_.step(1); }), "step failed: there is nothing to say");
}

TEST_F(ComponentBenchTest, KnowsThePortsAndTheirTypes) {
  EXPECT_THROW(bench_.send("seen", text("one")), std::invalid_argument);
  EXPECT_THROW(bench_.send("heard", msg::Bool{}), std::invalid_argument);
  EXPECT_THROW(bench_.take<msg::Bool>("said"), std::invalid_argument);
  EXPECT_THROW(bench_.take<msg::String>("heard"), std::invalid_argument);
}

TEST(ComponentHarness, ChecksParametersAsADeploymentDoes) {
  PluginRegistry plugins = with_shout();
  ComponentHarness loud{plugins,
                        {.component = "{plugin: test/shout, params: {mark: '!!!'}}", .robot = {}}};
  loud.send("heard", text("one"));
  loud.step(0);
  EXPECT_EQ(loud.take<msg::String>("said").front().data_(), "one!!!");
  EXPECT_EQ(test::refusal_of([&] {
              ComponentHarness wrong{
                  plugins, {.component = "{plugin: test/shout, params: {mrk: '!'}}", .robot = {}}};
            }),
            "bench:1:38: unknown key 'mrk' in params of 'test/shout'; did you "
            "mean 'mark'?");
}

TEST(ComponentHarness, RefusesAClassThatForgetsAPortOfItsPluginYaml) {
  PluginRegistry plugins{std::vector<std::filesystem::path>{}};
  plugins.add<Silent>(kManifest);
  EXPECT_THROW((ComponentHarness{plugins, {.component = "{plugin: test/shout}", .robot = {}}}),
               std::logic_error);
}

TEST(PluginRegistry, OfThisProgramRefusesAnIdThatIsThereAlreadyAndAnotherKind) {
  PluginRegistry plugins = with_shout();
  EXPECT_THROW(plugins.add<Shout>(kManifest), std::invalid_argument);
  EXPECT_EQ(test::refusal_of([&] { plugins.load(*plugins.find("test/shout"), "ik"); }),
            "plugin 'test/shout' cannot be used: this program: its class is of "
            "kind 'component', wanted 'ik'");
}

}  // namespace
}  // namespace armature
