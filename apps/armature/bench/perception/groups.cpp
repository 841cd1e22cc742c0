// SPDX-License-Identifier: Apache-2.0
#include "bench/perception/groups.hpp"

#include <array>

#include "armature/scene/face_traits.hpp"
#include "armature/values/angles.hpp"

namespace armature::bench {
namespace {

using scene::Occluder, scene::Surface;
using Sequence = CaseGroup::Sequence;

/// The cameras behind the coordinates that Jiang et al. 2021 print in section 5:
/// configs/rigs/paper.yaml.
constexpr StereoCamera kPaperCamera{.width = 1000,
                                    .height = 1000,
                                    .focal_px = 787.4015748,
                                    .cx = 500,
                                    .cy = 500,
                                    .baseline_m = 0.024};

/// The same field of view in 640 x 480 pixels.
StereoCamera small(StereoCamera camera) {
  camera.focal_px *= 640.0 / camera.width;
  return {.width = 640,
          .height = 480,
          .focal_px = camera.focal_px,
          .cx = 319.5,
          .cy = 239.5,
          .baseline_m = camera.baseline_m};
}

template <Occluder which>
void hold(DrawnCase& one, Draw&) {
  one.drawn.staging.occluder = which;
}
template <Occluder which>
void over_expose(DrawnCase& one, Draw& draw) {
  one.drawn.brightness = draw.between(1.4, 2);
  one.drawn.staging.occluder = which;
}
template <Surface::Shape shape>
void glue(DrawnCase& one, Draw& draw) {
  one.drawn.staging.surface = {shape, draw.between(0.08, 0.11)};
}
template <FaceWears what>
void wear(DrawnCase& one, Draw& draw) {
  one.drawn.face_seed = draw.face(what);
}
void darken_right(DrawnCase& one, Draw& draw) { one.drawn.right.gain = draw.between(0.5, 0.8); }
void roll_right(DrawnCase& one, Draw& draw) {
  one.drawn.right.roll = draw.either_side(0.2, 1) * kRadPerDegree;
}
void leave(DrawnCase&, Draw&) {}

constexpr std::array kGroups{
    CaseGroup{"frontal", leave},
    CaseGroup{"with glasses", wear<FaceWears::glasses>},
    CaseGroup{"with a beard", wear<FaceWears::beard>},
    CaseGroup{
        "yaw 15 to 30 deg",
        [](DrawnCase& one, Draw& draw) { one.yaw = draw.either_side(15, 30) * kRadPerDegree; }},
    CaseGroup{
        "yaw 30 to 45 deg",
        [](DrawnCase& one, Draw& draw) { one.yaw = draw.either_side(30, 45) * kRadPerDegree; }},
    CaseGroup{
        "pitch 15 to 30 deg",
        [](DrawnCase& one, Draw& draw) { one.pitch = draw.either_side(15, 30) * kRadPerDegree; }},
    CaseGroup{
        "pitch 30 to 45 deg",
        [](DrawnCase& one, Draw& draw) { one.pitch = draw.either_side(30, 45) * kRadPerDegree; }},
    CaseGroup{
        "roll 10 to 30 deg",
        [](DrawnCase& one, Draw& draw) { one.roll = draw.either_side(10, 30) * kRadPerDegree; }},
    CaseGroup{"distance 400 to 500 mm",
              [](DrawnCase& one, Draw& draw) { one.distance_m = draw.between(0.4, 0.5); }},
    CaseGroup{"distance 700 to 1200 mm",
              [](DrawnCase& one, Draw& draw) { one.distance_m = draw.between(0.7, 1.2); }},
    CaseGroup{"rig of the paper", [](DrawnCase& one, Draw&) { one.drawn.camera = kPaperCamera; }},
    CaseGroup{"640 x 480 px",
              [](DrawnCase& one, Draw&) { one.drawn.camera = small(one.drawn.camera); }},
    CaseGroup{"baseline 60 mm", [](DrawnCase& one, Draw&) { one.drawn.camera.baseline_m = 0.06; }},
    CaseGroup{"noise 6 to 12",
              [](DrawnCase& one, Draw& draw) { one.drawn.imaging.noise = draw.between(6, 12); }},
    CaseGroup{"blur 1 to 2.5 px",
              [](DrawnCase& one, Draw& draw) { one.drawn.imaging.blur_px = draw.between(1, 2.5); }},
    CaseGroup{"motion 4 to 12 px",
              [](DrawnCase& one, Draw& draw) {
                one.drawn.imaging.motion_px = {draw.either_side(4, 12), draw.either_side(0, 4)};
              }},
    CaseGroup{"dark, gain 0.2 to 0.5",
              [](DrawnCase& one, Draw& draw) { one.drawn.brightness = draw.between(0.2, 0.5); }},
    CaseGroup{"over-exposed, gain 1.4 to 2", over_expose<Occluder::none>},
    CaseGroup{"over-exposed, instrument", over_expose<Occluder::instrument_over_mouth>},
    CaseGroup{"over-exposed, hand over the mouth", over_expose<Occluder::hand_over_mouth>},
    CaseGroup{"over-exposed, hand over an eye", over_expose<Occluder::hand_over_eye>},
    CaseGroup{"over-exposed, mask", over_expose<Occluder::mask>},
    CaseGroup{
        "lower half in shadow",
        [](DrawnCase& one, Draw& draw) { one.drawn.staging.shadow = draw.between(0.5, 0.8); }},
    CaseGroup{"on a cylinder", glue<Surface::Shape::cylinder>},
    CaseGroup{"on a sphere", glue<Surface::Shape::sphere>},
    CaseGroup{"instrument over the mouth", hold<Occluder::instrument_over_mouth>},
    CaseGroup{"hand over the mouth", hold<Occluder::hand_over_mouth>},
    CaseGroup{"hand over an eye", hold<Occluder::hand_over_eye>},
    CaseGroup{"mask", hold<Occluder::mask>},
    CaseGroup{"a second face",
              [](DrawnCase& one, Draw& draw) {
                one.drawn.staging.second_face =
                    Eigen::Vector3d{draw.either_side(0.25, 0.35), draw.between(-0.05, 0.05),
                                    draw.between(0.2, 0.35)};
              }},
    CaseGroup{"another person in the right picture",
              [](DrawnCase& one, Draw& draw) {
                do {
                  one.drawn.right_face_seed = draw.face(FaceWears::nothing);
                } while (one.drawn.right_face_seed == one.drawn.face_seed);
                one.late_m = {draw.either_side(0.02, 0.08), draw.between(-0.002, 0.002), 0};
              }},
    CaseGroup{"right gain 0.5 to 0.8", darken_right},
    CaseGroup{"right rolled 0.2 to 1 deg", roll_right},
    CaseGroup{"right 1 to 5 rows off",
              [](DrawnCase& one, Draw& draw) {
                one.drawn.right.shift_px = {0, draw.either_side(1, 5)};
              }},
    CaseGroup{"right 1 to 5 columns off",
              [](DrawnCase& one, Draw& draw) {
                one.drawn.right.shift_px = {draw.either_side(1, 5), 0};
              }},
    CaseGroup{"right focal 1 to 3 % off",
              [](DrawnCase& one, Draw& draw) {
                one.drawn.right.focal = 1 + draw.either_side(0.01, 0.03);
              }},
    CaseGroup{
        "right late, face moved 3 to 15 mm",
        [](DrawnCase& one, Draw& draw) {
          const Eigen::Vector3d way{draw.between(-1, 1), draw.between(-1, 1), draw.between(-1, 1)};
          one.late_m = draw.between(0.003, 0.015) * way.normalized();
        }},
    CaseGroup{"tracked", leave, Sequence::tracked},
    CaseGroup{"tracked, frames lost, flicker", leave, Sequence::with_lost_frames},
    CaseGroup{"tracked, then an instrument", hold<Occluder::instrument_over_mouth>,
              Sequence::it_begins},
    CaseGroup{"tracked, then a hand on the mouth", hold<Occluder::hand_over_mouth>,
              Sequence::it_begins},
    CaseGroup{"tracked, then a hand on an eye", hold<Occluder::hand_over_eye>, Sequence::it_begins},
    CaseGroup{"tracked, then right rolled", roll_right, Sequence::it_begins},
    CaseGroup{"tracked, then right gain 0.5 to 0.8", darken_right, Sequence::it_begins},
};

}  // namespace

std::uint64_t Draw::face(FaceWears what) {
  constexpr std::uint64_t kFaces = 6;
  std::uint64_t left = (bits() >> 32) * kFaces >> 32;
  for (std::uint64_t seed = 1;; ++seed) {
    const scene::FaceTraits traits = scene::traits_of(seed);
    const bool wears_it = traits.has_glasses == (what == FaceWears::glasses) &&
                          traits.has_beard == (what == FaceWears::beard);
    if (wears_it && left-- == 0) return seed;
  }
}

std::span<const CaseGroup> case_groups() { return kGroups; }

}  // namespace armature::bench
