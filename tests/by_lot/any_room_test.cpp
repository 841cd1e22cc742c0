// SPDX-License-Identifier: Apache-2.0
// A lamp before whatever a room shows, of many things at once: what it believes is true to within 5
// mm and 3 degrees, or it believes nothing. What a pair of cameras cannot see is left
// out (plugins/face_pose/surface, Limits). ARMATURE_ROOMS: so many, from number ARMATURE_FIRST_ROOM
// on; `tools/test --full` has others every day.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "armature/values/chance.hpp"
#include "armature/values/file_content.hpp"
#include "armature/values/temporary_folder.hpp"
#include "deployment_run.hpp"
#include "tests/environment_number.hpp"

namespace armature::test {
namespace {

/// Settings of the scene, each of them in some of the rooms only.
class AnyRoom : private Chance {
 public:
  explicit AnyRoom(int seed) : Chance(seed) {
    tell("face_seed", 1 + below(500));
    tell("tilt_up_deg", between(-15, 15));
    tell("tilt_side_deg", between(-25, 25));
    if (happens(0.4)) tell("surface", happens(0.5) ? "cylinder" : "sphere");
    if (happens(0.15)) tell("noise", between(2, 40));
    if (happens(0.15)) tell("blur_px", between(0.5, 3));
    if (happens(0.15)) tell("gain", between(0.15, 2.5));
    if (happens(0.15)) tell("right_gain", between(0.5, 2));
    if (happens(0.1)) tell("flicker", between(0.1, 0.6));
    if (happens(0.1)) tell("shadow", between(0, 0.9));
    if (happens(0.1)) tell("right_roll_deg", between(-2, 2));
    if (happens(0.1)) tell("right_shift_px", fmt::format("[0, {:.3f}]", between(-4, 4)));
    if (happens(0.1)) tell("right_delay_s", between(0, 0.2));
    if (happens(0.2)) tell("dropped", between(0, 0.6));
    if (happens(0.2)) tell("repeated", between(0, 0.4));
    if (happens(0.2)) tell("second_face", "true");
    if (happens(0.3)) {
      const char* what[] = {"instrument_over_mouth", "hand_over_mouth", "hand_over_eye", "mask"};
      tell("occluder", what[below(4)]);
      tell("occluder_at_s", between(0, 20));
      tell("occluder_duration_s", between(0.1, 20));
    }
    if (happens(0.1)) {
      const char* what[] = {"left", "right", "both"};
      tell("frozen", what[below(3)]);
      tell("frozen_at_s", between(0, 20));
    }
    moves_ = happens(0.4);
    if (moves_) {
      tell("move_at_s", between(1, 15));
      tell("move_duration_s", between(0.3, 4));
      tell("move_mm", fmt::format("[{:.1f}, {:.1f}, {:.1f}]", between(-60, 60), between(-60, 60),
                                  between(-60, 60)));
      tell("move_tilt_side_deg", between(-15, 15));
    }
  }
  const std::vector<std::string>& settings() const { return settings_; }
  /// The patient does, once.
  bool moves() const { return moves_; }

 private:
  void tell(const std::string& what, const auto& value) {
    settings_.push_back(fmt::format("components.scene.params.{}={}", what, value));
  }

  std::vector<std::string> settings_;
  bool moves_ = false;
};

constexpr double kMouth_m = 0.005, kNormal_rad = 3 * M_PI / 180;

/// Everything that was ever believed of a patient who holds still: lines of the time, three figures
/// of the lamp, and how far mouth and normal are off, where they are believed.
void expect_true_estimates(const std::string& errors) {
  std::istringstream lines{errors};
  std::string line;
  std::getline(lines, line);
  ASSERT_TRUE(line.ends_with(",mouth_error_m,normal_error_rad")) << line;
  while (std::getline(lines, line)) {
    const std::size_t last = line.rfind(','), before = line.rfind(',', last - 1);
    if (last + 1 == line.size()) continue;
    ASSERT_LT(std::stod(line.substr(before + 1)), kMouth_m) << line;
    ASSERT_LT(std::stod(line.substr(last + 1)), kNormal_rad) << line;
  }
}

TEST(LampInAnyRoom, BelievesNothingThatIsNotSo) {
  const int first = environment_number("ARMATURE_FIRST_ROOM", 1),
            count = environment_number("ARMATURE_ROOMS", 3);
  int believed = 0;
  for (int seed = first; seed < first + count; ++seed) {
    const AnyRoom room{seed};
    std::vector<std::string> settings = room.settings();
    settings.insert(settings.end(), {kSimulated, "components.monitor=null", "run.time_limit_s=30"});
    const TemporaryFolder folder;
    const DeploymentRun run =
        run_deployment({.settings = settings, .report_folder = folder.path().string()});
    SCOPED_TRACE(fmt::format("room {}: {}\n{}", seed, fmt::join(settings, " "), run.text()));
    if (run.tells("mouth_position_error_mm")) {
      ++believed;
      EXPECT_LT(run.figure("mouth_position_error_mm"), 1e3 * kMouth_m);
      EXPECT_LT(run.figure("face_normal_error_deg"), kNormal_rad * 180 / M_PI);
    }
    if (!room.moves()) expect_true_estimates(content_of(folder / "errors.csv"));
    EXPECT_NE(run.status(), "fault");
    EXPECT_NE(run.status(), "none");
  }
  EXPECT_GT(believed, 0) << "of " << count << " rooms from number " << first << " on";
}

}  // namespace
}  // namespace armature::test
