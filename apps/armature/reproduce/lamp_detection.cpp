// SPDX-License-Identifier: Apache-2.0
#include "reproduce/lamp_detection.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "reproduce/experiment.hpp"

namespace armature::reproduce {
namespace {

constexpr int kLargest_deg = 45, kStep_deg = 5;
const std::string kScene = "components.scene.params.";

/// Two drawn faces and the portrait.
const std::vector<Variation> kPhotos{{kScene + "photo=generated", kScene + "face_seed=1"},
                                     {kScene + "photo=generated", kScene + "face_seed=2"},
                                     {kScene + "photo=astronaut"}};

/// All of them, turned by each angle to both sides; each pair of pictures has a noise of its own.
std::vector<Variation> turned(const std::string& tilt) {
  std::vector<Variation> all;
  for (int angle = 0; angle <= kLargest_deg; angle += kStep_deg) {
    for (const int sign : {1, -1}) {
      for (Variation photo : kPhotos) {
        photo.push_back(kScene + tilt + "=" + std::to_string(sign * angle));
        photo.push_back("seed=" + std::to_string(all.size() + 1));
        all.push_back(std::move(photo));
      }
    }
  }
  return all;
}

void add_turns(const std::string& table, const std::string& tilt, const std::string& curve,
               Results& results) {
  const auto reports = run_experiments("lamp_detection", turned(tilt));
  const std::size_t at_each = 2 * kPhotos.size();
  std::vector<double> angles, shares;
  for (std::size_t i = 0; i < reports.size(); i += at_each) {
    // The report tells where the mouth is in both pictures when there was a face in both.
    const auto found =
        std::ranges::count_if(std::span{reports}.subspan(i, at_each),
                              [](const auto& report) { return report.contains("mouth_px"); });
    angles.push_back(kStep_deg * static_cast<double>(angles.size()));
    shares.push_back(100.0 * static_cast<double>(found) / static_cast<double>(at_each));
    results.value(table, fmt::format("{:g} degrees", angles.back()), shares.back());
  }
  const auto first_missed = std::ranges::find_if(shares, [](double share) { return share < 100; });
  const auto all_found = static_cast<double>(first_missed - shares.begin());
  results.value(table, "the first angle with a face missed", kStep_deg * all_found);
  results.curve("detection", 0, curve, angles, shares);
}

}  // namespace

void add_detection(Results& results) {
  add_turns("detection_aside", "tilt_side_deg", "turned aside", results);
  add_turns("detection_upright", "tilt_up_deg", "turned up and down", results);
}

}  // namespace armature::reproduce
