// SPDX-License-Identifier: Apache-2.0
// A law, of numbers and places that are drawn by lot: a deployment or robot file in which one
// number is another one is refused with its place, or runs to an end. ARMATURE_FIRST_WRONG_NUMBER
// and ARMATURE_WRONG_NUMBERS draw others.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "armature/values/temporary_folder.hpp"
#include "command.hpp"
#include "tests/dds_domain.hpp"
#include "tests/environment_number.hpp"
#include "tests/text.hpp"

namespace armature::test {
namespace {

namespace fs = std::filesystem;
using testing::AnyOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

struct Stretch {
  std::size_t begin, length;
};

/// The numbers of a YAML file that stand alone as values, without those of comments.
std::vector<Stretch> numbers_in(const std::string& text) {
  std::vector<Stretch> numbers;
  for (std::size_t at = 1; at < text.size(); ++at) {
    if (text[at] == '#') at = std::min(text.find('\n', at), text.size() - 1);
    if (text[at - 1] != ' ' && text[at - 1] != '[') continue;
    const std::size_t end = std::min(text.find_first_not_of("-.0123456789", at), text.size());
    const bool is_value = end < text.size() && std::string{",]} \n"}.find(text[end]) != text.npos;
    if (end > at && is_value) numbers.push_back({at, end - at});
  }
  return numbers;
}

class AnyWrongNumber : public testing::Test {
 protected:
  AnyWrongNumber() { fs::copy(source_file("configs"), folder_.path(), kAll); }

  /// One number of one file becomes another; what was changed, for messages.
  std::string spoil(std::mt19937& random) const {
    const auto any = [&](std::size_t count) { return random() % count; };
    const std::vector<std::string> files{"sr1_biopsy.yaml", "robots/sr1_needle.yaml"};
    const std::vector<std::string> wrong{
        "-1",   "0",     "1e308", "1e-320", "1e5", "90", ".nan",  ".inf", "1,5",
        "5 mm", "\"2\"", "~",     "[1]",    "yes", "-0", "0.001", "1e-9", "99999999999999999999"};
    const std::string& file = files[any(files.size())];
    for (const std::string& each : files) {
      fs::copy(source_file("configs/" + each), folder_ / each,
               fs::copy_options::overwrite_existing);
    }
    std::string text = text_of(folder_ / file);
    const auto numbers = numbers_in(text);
    const auto [begin, length] = numbers.at(any(numbers.size()));
    const std::string before = text.substr(begin, length), by = wrong[any(wrong.size())];
    const auto line =
        std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(begin), '\n');
    text.replace(begin, length, by);
    std::ofstream{folder_ / file} << text;
    return file + ":" + std::to_string(line + 1) + ": " + before + " became " + by;
  }

  void judge() const {
    const std::string file = folder_ / "sr1_biopsy.yaml";
    const auto checked = run_command({armature(), "check", file});
    ASSERT_THAT(checked.exit_code, AnyOf(0, 3)) << checked.err;
    if (checked.exit_code == 3) {
      EXPECT_THAT(matches_of("^" + folder_.path().string() + "/[a-z0-9_/]+\\.yaml:[0-9]+:[0-9]+: ",
                             checked.err),
                  Not(IsEmpty()))
          << checked.err;
      return;
    }
    const auto run = run_command(
        {armature(), "run", file, "--json", "--domain", domain_, "--set", "run.time_limit_s=20"});
    ASSERT_THAT(run.exit_code, AnyOf(0, 1)) << run.err;
    const auto told = nlohmann::json::parse(run.out);
    // An arm that may brake but slowly is still on its way when `run: {stop_within_s}` is over.
    if (told.at("status") == "fault") {
      EXPECT_THAT(told.at("reason").get<std::string>(), HasSubstr("was not at rest")) << run.out;
      return;
    }
    EXPECT_THAT(told.at("status"), AnyOf("ok", "goals_missed", "refused", "held")) << run.out;
  }

 private:
  static constexpr auto kAll = fs::copy_options::recursive;
  const TemporaryFolder folder_;
  const std::string domain_ = std::to_string(unique_dds_domain());
};

TEST_F(AnyWrongNumber, IsRefusedWithItsPlaceOrTheRunComesToAnEnd) {
  const int first = environment_number("ARMATURE_FIRST_WRONG_NUMBER", 1),
            count = environment_number("ARMATURE_WRONG_NUMBERS", 8);
  for (int seed = first; seed < first + count; ++seed) {
    std::mt19937 random{static_cast<unsigned>(seed)};
    const std::string what = spoil(random);
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + what);
    judge();
  }
}

}  // namespace
}  // namespace armature::test
