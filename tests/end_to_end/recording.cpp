// SPDX-License-Identifier: Apache-2.0
#include "recording.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "armature/values/temporary_folder.hpp"

namespace armature::test {
namespace {

namespace fs = std::filesystem;

struct Line {
  std::int64_t key = 0;
  Eigen::VectorXd numbers;
};

/// Lines of one whole number and then others.
std::vector<Line> read_lines(const fs::path& file) {
  std::ifstream stream{file};
  if (!stream) throw std::runtime_error("cannot read " + file.string());
  std::vector<Line> lines;
  for (std::string text; std::getline(stream, text);) {
    std::istringstream cells{text};
    std::string cell;
    std::getline(cells, cell, ',');
    Line& line = lines.emplace_back();
    line.key = std::stoll(cell);
    std::vector<double> numbers;
    while (std::getline(cells, cell, ',')) numbers.push_back(std::stod(cell));
    line.numbers = Eigen::Map<const Eigen::VectorXd>(numbers.data(),
                                                     static_cast<Eigen::Index>(numbers.size()));
  }
  return lines;
}

Recording read_recording(const fs::path& folder) {
  Recording recording;
  for (const Line& line : read_lines(folder / "reference.csv")) {
    const Eigen::Index dof = line.numbers.size() / 3;
    recording.reference.push_back({.ns = line.key,
                                   .q = line.numbers.head(dof),
                                   .v = line.numbers.segment(dof, dof),
                                   .a = line.numbers.tail(dof)});
  }
  for (const Line& line : read_lines(folder / "goals.csv")) {
    recording.goals.push_back({.time_s = 1e-9 * static_cast<double>(line.key),
                               .goal_id = static_cast<std::uint64_t>(line.numbers[0]),
                               .state = static_cast<int>(line.numbers[1])});
  }
  for (const Line& line : read_lines(folder / "path.csv")) {
    recording.path[static_cast<std::uint64_t>(line.key)].push_back(
        {.position = line.numbers.head<3>(), .direction = line.numbers.tail<3>()});
  }
  for (const Line& line : read_lines(folder / "joint_path.csv")) {
    recording.joint_path[static_cast<std::uint64_t>(line.key)].push_back(line.numbers);
  }
  for (const Line& line : read_lines(folder / "jerk.csv")) {
    recording.greatest_jerk = std::max(recording.greatest_jerk, line.numbers[0]);
  }
  return recording;
}

}  // namespace

Recording record_lamp(DeploymentStart start, DeploymentRun& run) {
  const TemporaryFolder folder;
  start.files.push_back(source_file("tests/end_to_end/recorder.yaml"));
  start.options.environment["ARMATURE_PLUGIN_PATH"] = ARMATURE_BINARY_DIR "/tests/plugins";
  start.options.environment["RECORDER_FOLDER"] = folder.path();
  run = run_deployment(start);
  return read_recording(folder.path());
}

}  // namespace armature::test
