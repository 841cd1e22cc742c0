// SPDX-License-Identifier: Apache-2.0
// A viewer of another vendor builds its tree of frames while the lamp runs: the tool is where
// forward kinematics of the joints on measured_js puts it.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <csignal>
#include <cstdint>
#include <map>
#include <set>
#include <sstream>

#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "deployment_run.hpp"
#include "tests/dds_domain.hpp"

namespace armature::test {
namespace {

std::int64_t read_stamp(std::istringstream& words) {
  std::int64_t sec = 0, nanosec = 0;
  words >> sec >> nanosec;
  return sec * 1'000'000'000 + nanosec;
}

/// Joints by stamp, of lines "sec nanosec frame j1=position/velocity ...".
std::map<std::int64_t, std::vector<double>> read_joints(const std::string& lines) {
  std::map<std::int64_t, std::vector<double>> joints;
  std::istringstream text{lines};
  for (std::string line, word; std::getline(text, line);) {
    std::istringstream words{line};
    auto& positions = joints[read_stamp(words)];
    words >> word;  // the frame
    while (words >> word) positions.push_back(std::stod(word.substr(word.find('=') + 1)));
  }
  return joints;
}

struct Viewed {
  struct Marker {
    std::string ns, frame;
    int id = 0, type = 0, action = 0, points = 0;
  };
  std::map<std::int64_t, Eigen::Isometry3d> poses;  // PARENT_T_CHILD by stamp
  std::vector<Marker> markers;
};

Viewed read_view(const std::string& lines) {
  Viewed viewed;
  std::istringstream text{lines};
  for (std::string line, kind; std::getline(text, line);) {
    std::istringstream words{line};
    words >> kind;
    if (kind == "tf") {
      const std::int64_t stamp = read_stamp(words);
      Eigen::Vector3d p;
      Eigen::Quaterniond q;
      words >> p.x() >> p.y() >> p.z() >> q.x() >> q.y() >> q.z() >> q.w();
      viewed.poses[stamp] = Eigen::Translation3d{p} * q;
    } else {
      Viewed::Marker marker;
      words >> marker.ns >> marker.id >> marker.type >> marker.action >> marker.frame >>
          marker.points;
      viewed.markers.push_back(marker);
    }
    EXPECT_FALSE(words.fail()) << line;
  }
  return viewed;
}

/// How many poses have a joint sample of their stamp, how far they are off at most, and how far the
/// tool was seen to go.
struct Comparison {
  int samples = 0;
  double worst_m = 0, worst_rad = 0, way_m = 0;
};

Comparison compare(const std::map<std::int64_t, Eigen::Isometry3d>& poses,
                   const std::map<std::int64_t, std::vector<double>>& joints) {
  const RobotModel lamp = load_robot_model(source_file("configs/robots/dental_lamp.yaml"));
  Comparison result;
  for (const auto& [stamp, base_T_tool] : poses) {
    const auto sample = joints.find(stamp);
    if (sample == joints.end()) continue;
    const Eigen::Isometry3d expected =
        forward_kinematics(lamp, lamp.to_independent(sample->second).value());
    const Eigen::Isometry3d error = expected.inverse() * base_T_tool;
    ++result.samples;
    result.worst_m = std::max(result.worst_m, error.translation().norm());
    result.worst_rad =
        std::max(result.worst_rad, std::abs(Eigen::AngleAxisd{error.linear()}.angle()));
    result.way_m = std::max(
        result.way_m, (base_T_tool.translation() - poses.begin()->second.translation()).norm());
  }
  return result;
}

TEST(CycloneViewer, SeesTheToolWhereTheJointsPutItAndWhatTheLampIsAfter) {
  const std::string domain = std::to_string(unique_dds_domain());
  Command joints{{CYCLONE_LISTENER, domain, "rt/dental_lamp/arm/measured_js", "1000000", "170"}};
  Command viewer{{CYCLONE_VIEWER, domain, "rt/dental_lamp/markers", "base", "tool", "170"}};
  const DeploymentRun run =
      run_deployment({.settings = {"run.time_limit_s=120"}, .domain = std::stoi(domain)});
  EXPECT_EQ(run.status(), "ok") << run.text();
  joints.signal(SIGTERM);
  viewer.signal(SIGTERM);
  const Viewed viewed = read_view(viewer.finish(std::chrono::seconds{10}).out);
  const Comparison tool =
      compare(viewed.poses, read_joints(joints.finish(std::chrono::seconds{10}).out));
  EXPECT_GT(tool.samples, 100);
  EXPECT_LT(tool.worst_m, 1e-12);
  EXPECT_LT(tool.worst_rad, 1e-12);
  EXPECT_GT(tool.way_m, 0.1) << "the lamp was not seen moving";

  std::map<std::string, std::set<int>> actions;
  std::set<std::string> frames;
  for (const auto& marker : viewed.markers) {
    actions[marker.ns].insert(marker.action);
    frames.insert(marker.frame);
    if (marker.ns == "path" && marker.action == 0) {
      EXPECT_GE(marker.points, 2);
    }
  }
  EXPECT_EQ(actions["links"], std::set<int>{0});
  EXPECT_EQ(actions["path"], (std::set<int>{0, 2}))
      << "shown, and taken away when the lamp is there";
  EXPECT_TRUE(actions["target"].contains(0));
  EXPECT_EQ(actions["truth"], std::set<int>{0});
  EXPECT_TRUE(frames.contains("j3") && frames.contains("tool") && frames.contains("base"));
}

}  // namespace
}  // namespace armature::test
