// SPDX-License-Identifier: Apache-2.0
// The cases of `armature bench perception`: 1. the same for the same seed, and for fewer pairs the
// first of more, 2. in every group as many as there should be, with a face that both cameras
// see, 3. what a group's name says is so.
#include "bench/perception/cases.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "armature/scene/face_traits.hpp"
#include "armature/values/angles.hpp"
#include "bench/perception/groups.hpp"

namespace armature::bench {
namespace {

constexpr StereoCamera kPair{
    .width = 1280, .height = 720, .focal_px = 914, .cx = 639.5, .cy = 359.5, .baseline_m = 0.12};

std::map<std::string, std::vector<PerceptionCase>> by_group(int pairs, std::uint64_t seed = 1) {
  std::map<std::string, std::vector<PerceptionCase>> groups;
  for (PerceptionCase& one : perception_cases(kPair, pairs, seed)) {
    groups[one.group].push_back(std::move(one));
  }
  return groups;
}

TEST(PerceptionCases, AreAsManyAsAskedAndAtLeastOneOfEachGroup) {
  const auto groups = static_cast<int>(case_groups().size());
  EXPECT_EQ(perception_cases(kPair, 300, 1).size(), 300U);
  EXPECT_EQ(perception_cases(kPair, groups + 3, 1).size(), static_cast<std::size_t>(groups + 3));
  EXPECT_EQ(perception_cases(kPair, 1, 1).size(), static_cast<std::size_t>(groups));
  for (const auto& [group, cases] : by_group(1000))
    EXPECT_GE(cases.size(), 1000U / by_group(1).size());
}

TEST(PerceptionCases, OfFewerPairsAreTheFirstOfMoreAndFollowTheSeed) {
  const auto few = by_group(64), many = by_group(640), other = by_group(64, 2);
  for (const auto& [group, cases] : few) {
    SCOPED_TRACE(group);
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const PerceptionCase& same = many.at(group).at(i);
      EXPECT_EQ(cases[i].number, static_cast<int>(i));
      EXPECT_TRUE(cases[i].left_T_face.matrix() == same.left_T_face.matrix());
      EXPECT_EQ(cases[i].face_seed, same.face_seed);
      EXPECT_EQ(cases[i].noise_seed, same.noise_seed);
      EXPECT_EQ(cases[i].brightness, same.brightness);
      EXPECT_FALSE(cases[i].left_T_face.matrix() == other.at(group).at(i).left_T_face.matrix());
    }
  }
}

TEST(PerceptionCases, HaveAHeadThatBothCamerasSee) {
  for (const PerceptionCase& one : perception_cases(kPair, 2000, 3)) {
    SCOPED_TRACE(one.group + " " + std::to_string(one.number));
    for (const Eigen::Vector3d& on_face :
         {Eigen::Vector3d{-0.06, 0.03, 0}, {0.06, 0.03, 0}, {0, -0.12, 0}, {0, 0.05, 0}}) {
      const Eigen::Vector3d p = one.left_T_face * on_face;
      for (const Eigen::Vector2d& pixel :
           {one.camera.project_left(p), one.camera.project_right(p)}) {
        EXPECT_GE(pixel.x(), 0);
        EXPECT_LT(pixel.x(), one.camera.width);
        EXPECT_GE(pixel.y(), 0);
        EXPECT_LT(pixel.y(), one.camera.height);
      }
    }
  }
}

TEST(PerceptionCases, AreWhatTheNameOfTheirGroupSays) {
  const auto groups = by_group(640);
  for (const auto& one : groups.at("yaw 30 to 45 deg")) {
    const Eigen::Vector3d forward = one.left_T_face.linear().col(2);
    const double yaw = std::abs(std::atan2(forward.x(), forward.z())) / kRadPerDegree;
    EXPECT_GE(yaw, 29);
    EXPECT_LE(yaw, 46);
  }
  for (const auto& one : groups.at("distance 700 to 1200 mm")) {
    EXPECT_GE(one.left_T_face.translation().z(), 0.7);
    EXPECT_LE(one.left_T_face.translation().z(), 1.2);
  }
  for (const auto& [group, cases] : groups) {
    for (const auto& one : cases) {
      const scene::FaceTraits traits = scene::traits_of(one.face_seed);
      EXPECT_EQ(traits.has_glasses, group == "with glasses") << group;
      EXPECT_EQ(traits.has_beard, group == "with a beard") << group;
    }
  }
  for (const auto& one : groups.at("mask")) EXPECT_EQ(one.staging.occluder, scene::Occluder::mask);
  for (const auto& one : groups.at("another person in the right picture")) {
    ASSERT_TRUE(one.right_face_seed);
    EXPECT_NE(*one.right_face_seed, one.face_seed);
    const Eigen::Vector3d apart = one.right_shows.translation() - one.left_shows.translation();
    EXPECT_GT(std::abs(apart.x()), 0.02 - 1e-9);
    EXPECT_LT(std::abs(apart.y()), 0.002) << "rows tell nothing";
  }
  for (const auto& one : groups.at("baseline 60 mm")) EXPECT_EQ(one.camera.baseline_m, 0.06);
  for (const auto& one : groups.at("640 x 480 px")) EXPECT_EQ(one.camera.width, 640);
  for (const auto& one : groups.at("right late, face moved 3 to 15 mm")) {
    EXPECT_TRUE(one.left_shows.matrix() == one.left_T_face.matrix());
    const double late = (one.right_shows.translation() - one.left_T_face.translation()).norm();
    EXPECT_GE(late, 0.003);
    EXPECT_LE(late, 0.015);
  }
}

TEST(PerceptionCases, ThatAreTrackedContinueAndMoveLittle) {
  const auto groups = by_group(3200);
  for (const char* group : {"tracked", "tracked, frames lost, flicker"}) {
    SCOPED_TRACE(group);
    const auto& cases = groups.at(group);
    int sequences = 0, repeated = 0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
      sequences += !cases[i].continues;
      repeated += cases[i].repeats;
      EXPECT_EQ(cases[i].repeats, cases[i].left_shows.matrix() != cases[i].left_T_face.matrix());
      if (!cases[i].continues) continue;
      if (cases[i].repeats) {
        EXPECT_GT(i % 20, 3U) << "a host knows the noise of the cameras by then";
        EXPECT_TRUE(cases[i].left_shows.matrix() == cases[i - 1].left_shows.matrix());
        EXPECT_EQ(cases[i].noise_seed, cases[i - 1].noise_seed);
        EXPECT_EQ(cases[i].brightness, cases[i - 1].brightness);
      }
      const double moved =
          (cases[i].left_T_face.translation() - cases[i - 1].left_T_face.translation()).norm();
      EXPECT_LT(moved, 0.012);
      EXPECT_EQ(cases[i].face_seed, cases[i - 1].face_seed);
    }
    EXPECT_EQ(sequences, static_cast<int>((cases.size() + 19) / 20));
    EXPECT_EQ(repeated > 0, std::string{group} != "tracked");
  }
}

TEST(PerceptionCases, WhatBeginsInASequenceBeginsAfterItsSoundPairsAndStays) {
  const auto groups = by_group(8 * static_cast<int>(case_groups().size()));
  const auto& rolled = groups.at("tracked, then right rolled");
  ASSERT_EQ(rolled.size(), 8U);
  for (const PerceptionCase& one : rolled) {
    EXPECT_EQ(one.right.roll != 0, one.number >= kSoundPairs) << one.number;
    EXPECT_EQ(one.right.roll, one.number >= kSoundPairs ? rolled.back().right.roll : 0);
    EXPECT_EQ(one.continues, one.number > 0);
  }
  EXPECT_GT((rolled[4].left_shows.translation() - rolled[3].left_shows.translation()).norm(), 1e-4)
      << "the face goes on moving";
}

}  // namespace
}  // namespace armature::bench
