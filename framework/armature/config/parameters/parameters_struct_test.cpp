// SPDX-License-Identifier: Apache-2.0
#include "armature/config/parameters/parameters_struct.hpp"

#include <gtest/gtest.h>

#include "armature/config/document.hpp"
#include "tests/refusal.hpp"

namespace armature {
namespace {

std::string header_of(const std::string& params) {
  config::Problems problems;
  const std::string header = parameters_header(
      config::parse_text("id: task/lamp\nparams:\n" + params, "plugin.yaml"), problems);
  problems.throw_if_any();
  return header;
}

/// The lines between the braces of the struct.
std::string struct_of(const std::string& params) {
  const std::string header = header_of(params);
  const std::size_t begin = header.find("struct Parameters {\n") + 20;
  return header.substr(begin, header.find("\n};", begin) - begin);
}

std::string refusal(const std::string& params) {
  return test::refusal_of([&] { header_of(params); });
}

TEST(TheStructOfParameters, HasTypedMembersInSiUnitsWithDocAndDefault) {
  EXPECT_EQ(struct_of(R"(
  distance_m: {type: number, default: 0.5, min: 0.1, max: 2, doc: Of the lamp}
  lag_ms: {type: number, default: 20}
  frames: {type: integer, default: 2, min: 1, max: 100, doc: "To be seen"}
  seed: {type: integer, default: 1, min: 0}
  shift: {type: integer, default: -1}
  path_only: {type: flag, default: true}
  flange_mm: {type: numbers, count: 3, default: [60, -35, 0]}
  sites_m: {type: numbers, default: []}
  name: {type: text, default: 'a "b"'}
  model: {type: file, default: /a/b.dat}
  command: {type: texts, default: [a, b]}
  photo: {type: choice, choices: [generated, default], default: default}
)"),
            R"(  enum class Photo { generated, default_ };
  /// [m] Of the lamp
  double distance{0.5};
  /// [s]
  double lag{0.02};
  /// To be seen
  int frames{2};
  std::uint64_t seed{1};
  std::int64_t shift{-1};
  bool path_only{true};
  /// [m]
  std::array<double, 3> flange{0.06, -0.035, 0.0};
  /// [m]
  std::vector<double> sites{};
  std::string name{"a \"b\""};
  std::string model{"/a/b.dat"};
  std::vector<std::string> command{"a", "b"};
  Photo photo = Photo::default_;

  static Parameters read(const Params& params) {
    return {.distance = params.number("distance_m"),
            .lag = params.number("lag_ms"),
            .frames = static_cast<int>(params.integer("frames")),
            .seed = static_cast<std::uint64_t>(params.integer("seed")),
            .shift = static_cast<std::int64_t>(params.integer("shift")),
            .path_only = params.flag("path_only"),
            .flange = params.numbers<3>("flange_mm"),
            .sites = params.numbers("sites_m"),
            .name = params.text("name"),
            .model = params.file("model"),
            .command = params.texts("command"),
            .photo = static_cast<Photo>(params.choice("photo"))};
  })");
}

TEST(TheStructOfParameters, StandsInTheNamespaceOfThePluginsId) {
  EXPECT_NE(header_of("  a: {type: flag}").find("\nnamespace armature::task::lamp {\n"),
            std::string::npos);
}

TEST(TheStructOfParameters, KeepsTheUnitsOfNamesThatDifferInThemOnly) {
  const std::string text = struct_of(R"(
  curve_mm: {type: number, default: 1}
  curve_hz: {type: number, default: 2}
)");
  EXPECT_NE(text.find("double curve_m{0.001};"), std::string::npos) << text;
  EXPECT_NE(text.find("double curve_hz{2.0};"), std::string::npos) << text;
}

TEST(TheStructOfParameters, OfAPluginWithoutParametersIsEmpty) {
  config::Problems problems;
  const auto manifest = config::parse_text("id: ik/x", "plugin.yaml");
  EXPECT_NE(parameters_header(manifest, problems).find("read(const Params&) {\n    return {};"),
            std::string::npos);
}

TEST(TheStructOfParameters, IsCppWhateverATextHolds) {
  const std::string text = struct_of(
      "  a: {type: text, default: \"x\\ty\\nz\", doc: 'in C:\\'}\n"
      "  default: {type: flag, default: true}\n");
  EXPECT_NE(text.find("in C:\\."), std::string::npos) << text;
  EXPECT_NE(text.find(R"(std::string a{"x\011y\012z"};)"), std::string::npos) << text;
  EXPECT_NE(text.find("bool default_{true};"), std::string::npos) << text;
}

TEST(TheStructOfParameters, StandsInANamespaceThatIsOneWhateverTheIdIs) {
  config::Problems problems;
  EXPECT_NE(parameters_header(config::parse_text("id: operator/my-pedal", "f"), problems)
                .find("namespace armature::operator_::my_pedal {"),
            std::string::npos);
}

TEST(TheStructOfParameters, IsNotMadeOfAnotherFormatOrForAnotherIdThanThatOfTheBuild) {
  const auto said = [](const std::string& yaml) -> std::string {
    config::Problems problems;
    check_plugin(config::parse_text(yaml, "plugin.yaml"), "arm/lab", problems);
    return problems.empty() ? "" : config::ConfigError{problems.sorted()}.what();
  };
  EXPECT_EQ(said("armature_plugin: 1\nid: arm/lab\n"), "");
  EXPECT_EQ(said("armature_plugin: 1\nid: arm/lib\n"),
            "plugin.yaml:2:5: the id is 'arm/lib', and CMakeLists.txt says "
            "armature_add_plugin(arm/lab ...): write the same in both");
  EXPECT_EQ(said("armature_plugin: 2\nid: arm/lab\n"),
            "plugin.yaml:1:18: 'armature_plugin' is 2, must be 1: the format that this version "
            "reads");
}

TEST(TheStructOfParameters, IsNotMadeOfAChoiceThatIsNoName) {
  EXPECT_EQ(refusal("  photo: {type: choice, choices: [a-b], default: a-b}"),
            "plugin.yaml:3:3: parameter 'photo': the choice 'a-b' must be a name, of letters, "
            "digits and '_'");
}

}  // namespace
}  // namespace armature
