// SPDX-License-Identifier: Apache-2.0
// `armature schema` of deployments against what reading takes and refuses.
#include <algorithm>
#include <set>
#include <sstream>

#include "judged_by_schema.hpp"

namespace armature::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

struct Schema : JudgedBySchema {
  /// What reading says.
  json problems_of(const std::string& yaml) const {
    const auto result = run_command({armature(), "check", "--json", written(yaml)});
    return json::parse(result.out)["problems"];
  }
};

/// "{run: , name: }" of the keys under `properties`; `also` stands before them.
std::string with_all_keys(const json& schema, const std::string& also = "") {
  std::string text = "{" + also;
  for (const auto& [key, value] : schema.at("properties").items()) {
    if (key != "plugin") text += (text.size() > 1 ? ", " : "") + key + ": ";
  }
  return text + "}";
}

TEST_F(Schema, FitsEveryDeploymentThatIsShipped) { expect_fits_all_in("configs", 5); }

TEST_F(Schema, RefusesMisspeltKeysWrongTypesAndNumbersOutOfRange) {
  std::vector<std::pair<std::string, std::string>> wrong{
      {"clokc: system", "clokc"},
      {"clock: fast", "clock: "},
      {"domain: 300", "domain: 300"},
      {"domain: 1.5", "domain: 1.5"},
      {"seed: soon", "seed: "},
      {"include: {a: b}", "include: "},
      {"run: {time_limit: 3}", "time_limit"},
      {"run: {stop_within_s: 0.01}", "stop_within_s: 0.01"},
      {"dds: {interface: [eth0]}", "interface"},
      {"executors: {control: {period_s: '0.001'}}", "executors.control.period_s: "},
      {"executors: {control: {lock_memory: 1}}", "executors.control.lock_memory: "},
      {"robots: {arm: [a.yaml]}", "robots.arm: "},
      {"goals: {distance_eror_mm: 1}", "distance_eror_mm"},
      {"goals: {distance_error_mm: -1}", "goals.distance_error_mm: -1"},
      {"components: {runtime: {}}", "'runtime'"},
      {"components: {arm: {exectuor: main}}", "exectuor"},
      {"components: {arm: {plugin: arm/simulatd}}", "arm/simulatd"},
      {"components: {arm: {plugin: transport/fast_dds}}", "transport/fast_dds"},
      {"components: {arm: {plugin: arm/simulated, rig: head}}", "'rig'"},
      {"components: {arm: {plugin: arm/simulated, on_fault: go}}", "components.arm.on_fault: "},
      {"components: {arm: {plugin: arm/simulated, out: {servo: x}}}", "'servo'"},
      {"components: {s: {plugin: ik/numeric, params: {max_restart: 3}}}", "'max_restart'"},
      {"components: {s: {plugin: ik/numeric, params: {max_restarts: -3}}}", "max_restarts: -3"},
      {"components: {s: {plugin: ik/numeric, params: {max_restarts: few}}}", "'few'"},
      {"components: {motion: {ik: {plugin: path/needle}}}", "'path/needle'"},
      {"components: {motion: {ik: {plugin: ik/numeric, params: {a: 1}}}}", "'a'"},
      {"components: {motion: {ik: {plugins: ik/numeric}}}", "'plugins'"},
      {"components: {motion: {params: {distance_m: 1}}}", "'distance_m'"},
  };
  for (auto& [line, said] : wrong) line = "armature: 1\nname: x\n" + line + "\n";
  expect_refused(wrong);
}

TEST_F(Schema, RefusesAsReadingDoesANameThatCannotBeANamespace) {
  expect_refused({{"armature: 1\nname: ''\n", "''"},
                  {"armature: 1\nname: 7th\n", "'7th'"},
                  {"armature: 1\nname: " + std::string(65, 'n') + "\n", "nnn"}});
  EXPECT_EQ(judged_text("armature: 1\nname: " + std::string(64, 'n') + "\n"), "");
}

TEST_F(Schema, TakesVariablesForNumbersFlagsWordsAndPlugins) {
  EXPECT_EQ(judged_text("armature: 1\nname: ${NAME}\ndomain: ${DOMAIN:-3}\nclock: ${CLOCK}\n"
                        "executors: {control: {period_s: \"${PERIOD:-1e-3}\", lock_memory: "
                        "\"${LOCK:-false}\"}}\n"
                        "components:\n"
                        "  s: {plugin: \"${IK:-ik/numeric}\", params: {max_restarts: 3}}\n"
                        "  motion:\n"
                        "    ik:\n"
                        "      plugin: ${IK:-ik/numeric}\n"
                        "      params: {max_restarts: \"${RESTARTS:-3}\"}\n"),
            "");
}

TEST_F(Schema, TakesOverlaysWhichSayAPartAndRemoveTheRest) {
  EXPECT_EQ(judged_text(""), "");
  EXPECT_EQ(judged_text("components:\n"
                        "  report: null\n"
                        "  scene: {params: {eye_distance_mm: 104, tilt_up_deg: null}, rig: ~}\n"
                        "  motion: {params: {stand_off_mm: 1}, ik: {params: {max_restarts: 3}}}\n"
                        "goals: null\n"
                        "executors: {control: null}\n"),
            "");
}

TEST_F(Schema, TakesEveryWayToWriteANumberAndAText) {
  EXPECT_EQ(judged_text("armature: 1\nname: on\nseed: 18446744073709551615\n"
                        "run: {time_limit_s: +1e1, stop_within_s: .5}\n"
                        "executors: {7: {period_s: 1e-3}}\n"
                        "components: {s: {plugin: ik/numeric, executor: 7, params: , in: }}\n"),
            "");
}

TEST_F(Schema, KnowsNoKeyThatReadingDoesNotKnow) {
  json root = schema_;
  for (const char* typed : {"armature", "include", "run", "dds", "executors", "components"}) {
    root["properties"].erase(typed);
  }
  const json& sections = schema_["properties"];
  std::string yaml = "armature: 1\n";
  for (const auto& [key, value] : root["properties"].items()) yaml += key + ":\n";
  yaml += "run: " + with_all_keys(sections["run"]) + "\n";
  yaml += "dds: " + with_all_keys(sections["dds"]) + "\n";
  yaml += "executors: {e: " + with_all_keys(sections["executors"]["additionalProperties"]) + "}\n";
  yaml += "components:\n";
  int component = 0;
  for (const auto& [name, definition] : schema_["$defs"].items()) {
    if (!name.starts_with("component:")) continue;
    yaml += "  c" + std::to_string(++component) + ": ";
    yaml += with_all_keys(definition, "plugin: " + name.substr(name.find(':') + 1)) + "\n";
  }
  ASSERT_GT(component, 20);
  const json problems = problems_of(yaml);
  EXPECT_GT(problems.size(), 20U) << "no value is given: " << problems;
  for (const json& problem : problems) {
    const auto text = problem["text"].get<std::string>();
    EXPECT_THAT(text, Not(HasSubstr("unknown key"))) << problem;
    EXPECT_THAT(text, Not(testing::ContainsRegex("component '.*' uses no r"))) << problem;
  }
}

/// The words of "known: cpu, lock_memory, ..."; those that are left out are so at its end.
std::set<std::string> known_words(const json& problem) {
  std::istringstream hint{problem.at("hint").get<std::string>()};
  std::set<std::string> words;
  std::string word;
  hint >> word;  // "known:"
  while (hint >> word) {
    std::erase(word, ',');
    if (word != "...") words.insert(word);
  }
  return words;
}

TEST_F(Schema, KnowsTheKeysThatReadingKnows) {
  const std::string strange = "zzzzzzzzzz: 1";
  const std::string yaml =
      "armature: 1\n" + strange + "\nrun: {" + strange + "}\ndds: {" + strange +
      "}\nexecutors: {e: {" + strange + "}}\ncomponents:\n  s: {plugin: arm/simulated, " + strange +
      ", params: {" + strange + "}}\n  motion: {ik: {" + strange + ", plugin: ik/numeric}}\n";
  const json& sections = schema_["properties"];
  const json& definitions = schema_["$defs"];
  const json& arm = definitions["component:arm/simulated"];
  const std::vector<std::pair<std::string, json>> places{
      {"in the deployment", schema_},
      {"in run", sections["run"]},
      {"in dds", sections["dds"]},
      {"in executor 'e'", sections["executors"]["additionalProperties"]},
      {"in component 's'", arm},
      {"in params of 'arm/simulated'", arm["properties"]["params"]},
      {"in slot 'ik'", definitions["slot:ik"]}};
  const json problems = problems_of(yaml);
  for (const auto& [place, schema] : places) {
    const auto is_there = [text = "unknown key 'zzzzzzzzzz' " + place](const json& problem) {
      return problem["text"] == text;
    };
    const auto problem = std::ranges::find_if(problems, is_there);
    ASSERT_NE(problem, problems.end()) << place;
    const auto words = known_words(*problem);
    EXPECT_THAT(words, Not(IsEmpty())) << place;
    for (const std::string& word : words) {
      // Asked for so that a component without use for them can be told so.
      if (word == "robot" || word == "rig") continue;
      EXPECT_TRUE(schema["properties"].contains(word)) << word << " " << place;
    }
  }
}

TEST_F(Schema, HasEveryParameterOfEveryPluginWithItsLimitsItsDefaultAndItsDoc) {
  const auto restarts = schema_["$defs"]["component:ik/numeric"]["properties"]["params"]
                               ["properties"]["max_restarts"];
  EXPECT_EQ(restarts["type"][0], "integer");
  EXPECT_EQ(restarts["minimum"], 0);
  EXPECT_TRUE(restarts["default"].is_number_integer()) << restarts;
  EXPECT_NE(restarts["description"], "");
  const json list = json::parse(run_command({armature(), "plugin", "list", "--json"}).out);
  int params = 0;
  for (const json& plugin : list["plugins"]) {
    const std::string name = "component:" + plugin["id"].get<std::string>();
    if (!schema_["$defs"].contains(name)) continue;  // no component, and nothing runs it alone
    for (const json& param : plugin["params"]) {
      const json& known = schema_["$defs"][name]["properties"]["params"]["properties"];
      EXPECT_TRUE(known.contains(param["name"])) << name << " " << param;
      ++params;
    }
  }
  EXPECT_GT(params, 100);
}

}  // namespace
}  // namespace armature::test
