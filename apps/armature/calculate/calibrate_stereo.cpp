// SPDX-License-Identifier: Apache-2.0
#include "calculate/calibrate_stereo.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "armature/values/json_text.hpp"
#include "exit_code.hpp"
#include "standard_output.hpp"

namespace armature {

int run_stereo_calibration(const StereoCalibrationOptions& options) {
  const auto program =
      std::filesystem::canonical("/proc/self/exe").parent_path() / "armature-calibrate-stereo";
  const std::string words = json_text(nlohmann::json{{"left", options.left},
                                                     {"right", options.right},
                                                     {"board", options.board},
                                                     {"square_mm", options.square_mm},
                                                     {"output", options.output},
                                                     {"rig", options.rig},
                                                     {"coverage", options.coverage},
                                                     {"with_k3", options.with_k3},
                                                     {"json", options.json}});
  dup2(standard_output_descriptor(), STDOUT_FILENO);  // the result is that program's
  execl(program.c_str(), program.c_str(), words.c_str(), nullptr);
  fmt::print(stderr, "{}: {}{}\n", program.string(), std::strerror(errno),
             errno == ENOENT ? "; it is built where OpenCV is: -DARMATURE_VISION=ON" : "");
  return kFailed;
}

}  // namespace armature
