// SPDX-License-Identifier: Apache-2.0
#include "bench/perception/cases.hpp"

#include <algorithm>
#include <cmath>

#include "armature/scene/splitmix.hpp"
#include "armature/values/angles.hpp"
#include "bench/perception/groups.hpp"

namespace armature::bench {
namespace {

constexpr int kSequence = 20;      // pairs of one face that is tracked
constexpr double kPeriod_s = 0.1;  // between them

Eigen::Isometry3d left_T_face(const DrawnCase& one) {
  using Eigen::AngleAxisd, Eigen::Vector3d;
  return Eigen::Translation3d{0.5 * one.drawn.camera.baseline_m + one.aside_m, one.below_m,
                              one.distance_m} *
         (AngleAxisd{one.yaw, Vector3d::UnitY()} * AngleAxisd{one.pitch, Vector3d::UnitX()} *
          AngleAxisd{one.roll, Vector3d::UnitZ()});
}

PerceptionCase placed(DrawnCase one) {
  PerceptionCase& result = one.drawn;
  result.left_T_face = left_T_face(one);
  result.left_shows = result.right_shows = result.left_T_face;
  result.right_shows.pretranslate(one.late_m);
  return result;
}

/// What every case has; the mouth lies a little below the middle, so that the head is in the
/// picture.
DrawnCase usual_case(const StereoCamera& camera, Draw& draw) {
  DrawnCase one;
  one.drawn.camera = camera;
  one.drawn.face_seed = draw.face(FaceWears::nothing);
  one.distance_m = draw.between(0.5, 0.7);
  one.aside_m = draw.between(-0.06, 0.06);
  one.below_m = draw.between(-0.01, 0.05);
  one.yaw = draw.between(-12, 12) * kRadPerDegree;
  one.pitch = draw.between(-12, 12) * kRadPerDegree;
  one.roll = draw.between(-6, 6) * kRadPerDegree;
  return one;
}

/// The motion of a tracked face: to and fro and around, at most 50 mm/s and 15 deg/s.
struct Motion {
  explicit Motion(Draw& draw) {
    for (double& phase : phases) phase = draw.between(0, 2 * std::numbers::pi);
  }
  DrawnCase at(DrawnCase one, double t_s) const {
    one.aside_m += 0.04 * std::sin(0.9 * t_s + phases[0]);
    one.distance_m += 0.03 * std::sin(0.7 * t_s + phases[1]);
    one.yaw += 10 * kRadPerDegree * std::sin(1.1 * t_s + phases[2]);
    one.pitch += 6 * kRadPerDegree * std::sin(1.3 * t_s + phases[3]);
    return one;
  }
  double phases[4];
};

/// A face that moves. With frames lost, after the sound pairs, of five frames the third never
/// comes, and the cameras give the fourth one again for the fifth; the light goes up and down by a
/// quarter.
void add_sequence(const CaseGroup& group, const StereoCamera& camera, int pairs, Draw& draw,
                  std::vector<PerceptionCase>& cases) {
  const DrawnCase sound = usual_case(camera, draw);
  const Motion motion{draw};
  DrawnCase faulty = sound;
  group.draw(faulty, draw);
  const bool lost = group.sequence == CaseGroup::Sequence::with_lost_frames;
  for (int pair = 0, frame = 0; pair < pairs; ++pair, ++frame) {
    if (lost && pair >= kSoundPairs && frame % 5 == 2) ++frame;
    PerceptionCase now = placed(motion.at(pair < kSoundPairs ? sound : faulty, kPeriod_s * frame));
    if (lost) now.brightness = 0.8 + 0.2 * std::sin(2 * std::numbers::pi * 0.17 * frame);
    if (lost && frame % 5 == 4) {
      const Eigen::Isometry3d left_T_face = now.left_T_face;
      now = cases.back();
      now.left_T_face = left_T_face;
      now.repeats = true;
    }
    now.continues = pair > 0;
    cases.push_back(now);
  }
}

void add_group(const CaseGroup& group, const StereoCamera& camera, int pairs, Draw draw,
               std::vector<PerceptionCase>& cases) {
  for (int left = pairs; left > 0;) {
    if (group.sequence == CaseGroup::Sequence::none) {
      DrawnCase one = usual_case(camera, draw);
      group.draw(one, draw);
      cases.push_back(placed(one));
      --left;
    } else {
      add_sequence(group, camera, std::min(left, kSequence), draw, cases);
      left -= std::min(left, kSequence);
    }
  }
}

std::uint64_t hash_of(std::string_view text) {
  std::uint64_t hash = 0;
  for (const char c : text) hash = scene::splitmix(hash ^ static_cast<unsigned char>(c));
  return hash;
}

}  // namespace

std::vector<PerceptionCase> perception_cases(const StereoCamera& camera, int pairs,
                                             std::uint64_t seed) {
  std::vector<PerceptionCase> cases;
  const auto groups = case_groups();
  const auto count = static_cast<int>(groups.size());
  for (int g = 0; g < count; ++g) {
    const CaseGroup& group = groups[static_cast<std::size_t>(g)];
    const std::uint64_t own_seed = scene::splitmix(seed) ^ hash_of(group.name);
    const std::size_t first = cases.size();
    add_group(group, camera, std::max(1, pairs / count + (g < pairs % count)), Draw{own_seed},
              cases);
    for (std::size_t i = first; i < cases.size(); ++i) {
      cases[i].group = group.name;
      cases[i].number = static_cast<int>(i - first);
      cases[i].noise_seed =
          cases[i].repeats ? cases[i - 1].noise_seed : scene::splitmix(own_seed + i - first);
    }
  }
  return cases;
}

}  // namespace armature::bench
