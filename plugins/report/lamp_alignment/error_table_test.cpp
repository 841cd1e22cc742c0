// SPDX-License-Identifier: Apache-2.0
#include "error_table.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "armature/values/file_content.hpp"
#include "armature/values/temporary_folder.hpp"

namespace armature::report::lamp_alignment {
namespace {

TEST(ErrorTable, HasARowForEveryErrorAndLeavesEmptyWhatIsNotKnown) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "errors.csv";
  write_error_table(
      std::vector<LampError>{{.time_s = 0.02, .distance_m = 0.75, .direction_error_rad = 0.5},
                             {.time_s = 0.04,
                              .distance_m = 0.505,
                              .direction_error_rad = 0.25,
                              .distance_error_m = 0.005,
                              .mouth_error_m = 0.0008,
                              .normal_error_rad = 0.001}},
      file);
  EXPECT_EQ(
      content_of(file),
      "time_s,distance_m,distance_error_m,direction_error_rad,mouth_error_m,normal_error_rad\n"
      "0.020000,0.75,,0.5,,\n"
      "0.040000,0.505,0.005,0.25,0.0008,0.001\n");
}

}  // namespace
}  // namespace armature::report::lamp_alignment
