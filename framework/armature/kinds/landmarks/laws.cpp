// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/landmarks/laws.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace armature {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// True, and the law is skipped, when nobody gave a picture.
bool lacks_face(const LandmarkSubject& subject, LawCheck& check) {
  if (!subject.face) check.skip("no picture of a face was given");
  return !subject.face;
}

struct Framed {
  Picture picture;
  PixelBox box;
};

/// For laws that hold for every picture: the face, or a wall when nobody gave one.
Framed face_or_wall(const LandmarkSubject& subject) {
  if (subject.face) return {subject.face(), subject.box};
  return {Picture::of_one_grey(100), {110, 70, 100, 100}};
}

std::string text(const PixelBox& box) {
  return fmt::format("a box of {} x {} px at ({}, {})", box.width, box.height, box.left, box.top);
}

bool expect_as_many(const LandmarkSubject& subject, const std::vector<Landmark>& found,
                    LawCheck& check) {
  return check.equal(found.size(), landmark_count(subject.finder().scheme()),
                     "the number of landmarks");
}

void expect_same(const std::vector<Landmark>& a, const std::vector<Landmark>& b, LawCheck& check) {
  if (!check.equal(a.size(), b.size(), "the number of landmarks")) return;
  for (std::size_t i = 0; i < a.size(); ++i) {
    check.that(a[i].point == b[i].point,
               fmt::format("landmark {} has the same place, to the bit", i));
    check.equal(a[i].sigma, b[i].sigma, fmt::format("the sigma of landmark {} [px]", i));
  }
}

void finds_near_box(const LandmarkSubject& subject, LawCheck& check) {
  if (lacks_face(subject, check)) return;
  const Picture picture = subject.face();
  const PixelBox& box = subject.box;
  check.asks("the picture of a face, " + text(box));
  const auto found = subject.finder().find(picture.view(), box);
  if (!check.answered(found, "a face")) return;
  if (!expect_as_many(subject, *found, check)) return;
  for (std::size_t i = 0; i < found->size(); ++i) {
    const auto& [point, sigma] = (*found)[i];
    if (!check.that(point.allFinite(), fmt::format("landmark {} is finite", i))) return;
    check.that(point.x() >= box.left - box.width && point.x() <= box.right() + box.width &&
                   point.y() >= box.top - box.height && point.y() <= box.bottom() + box.height,
               fmt::format("landmark {} at ({}, {}) px is at most one box away from the box", i,
                           point.x(), point.y()));
    check.that(sigma > 0 && std::isfinite(sigma),
               fmt::format("the sigma of landmark {}, {} px, is positive and finite", i, sigma));
  }
}

void tells_features_apart(const LandmarkSubject& subject, LawCheck& check) {
  if (lacks_face(subject, check)) return;
  LandmarkFinder& finder = subject.finder();
  const Picture picture = subject.face();
  const double width = subject.box.width;
  check.asks("the picture of a face, " + text(subject.box));
  const auto found = finder.find(picture.view(), subject.box);
  if (!check.answered(found, "a face")) return;
  if (!expect_as_many(subject, *found, check)) return;
  const FaceLandmarks face{.scheme = finder.scheme(), .points = *found, .box = subject.box};
  const auto at = [&](FaceFeature feature) { return face.feature(feature).point; };
  const Eigen::Vector2d left = at(FaceFeature::left_eye), right = at(FaceFeature::right_eye);
  const double eyes = right.x() - left.x(), mouth = at(FaceFeature::mouth).y();
  check.that(
      eyes > 0.2 * width,
      fmt::format("the right eye is right of the left one by more than 0.2 box widths: {} of "
                  "{} px",
                  eyes, width));
  const auto expect_below = [&](const Eigen::Vector2d& eye, std::string_view name) {
    check.that(mouth > eye.y() + 0.5 * eyes,
               fmt::format("the mouth is below the {} eye by more than half the distance of the "
                           "eyes: {} px, the eyes {} px",
                           name, mouth - eye.y(), eyes));
  };
  expect_below(left, "left");
  expect_below(right, "right");
}

void repeats_bits(const LandmarkSubject& subject, LawCheck& check) {
  if (lacks_face(subject, check)) return;
  LandmarkFinder& finder = subject.finder();
  const Picture face = subject.face();
  check.asks("the picture of a face, noise of seed 1, the picture of the face again");
  const auto first = finder.find(face.view(), subject.box);
  static_cast<void>(finder.find(Picture::of_noise(1).view(), {10, 10, 100, 100}));
  const auto second = finder.find(face.view(), subject.box);
  if (!check.answered(first, "a picture") || !check.answered(second, "the same picture")) return;
  expect_same(*second, *first, check);
}

void takes_longer_rows(const LandmarkSubject& subject, LawCheck& check) {
  if (lacks_face(subject, check)) return;
  const Picture face = subject.face(), longer = face.with_longer_rows(37);
  check.asks(fmt::format("the picture, {} px wide, in rows of {}", face.width, longer.width));
  ImageView view = longer.view();
  view.width = face.width;
  const auto found = subject.finder().find(view, subject.box);
  const auto same = subject.finder().find(face.view(), subject.box);
  if (!check.answered(found, "a picture in longer rows")) return;
  if (!check.answered(same, "the same picture in rows of its width")) return;
  expect_same(*found, *same, check);
}

void answers_any_box(const LandmarkSubject& subject, LawCheck& check) {
  const Picture picture = face_or_wall(subject).picture;
  const std::vector<PixelBox> boxes{{-1e6, 0, 50, 50},  {1e6, 1e6, 50, 50}, {10, 10, 0, 0},
                                    {0, 0, 1e-3, 1e-3}, {0, 0, 1e9, 1e9},   {-50, 900, 1, 1},
                                    {0, 0, 1, 1e5},     {10, 10, -30, -30}, {kNan, 0, 50, 50},
                                    {0, 0, kNan, 50}};
  for (const PixelBox& box : boxes) {
    check.asks(text(box));
    const auto found = subject.finder().find(picture.view(), box);
    if (!found) {
      check.that(!found.error().text.empty(), "a refusal says why");
      continue;
    }
    expect_as_many(subject, *found, check);
    for (std::size_t i = 0; i < found->size(); ++i) {
      check.that((*found)[i].point.allFinite(), fmt::format("landmark {} is finite", i));
    }
  }
}

void refuses_no_image(const LandmarkSubject& subject, LawCheck& check) {
  const auto [picture, box] = face_or_wall(subject);
  check.asks("a view of no pixels");
  check.refused_with(subject.finder().find({}, box), "empty image");
  ImageView flat = picture.view();
  flat.height = 0;
  check.asks("a view 0 px high");
  check.refused_with(subject.finder().find(flat, box), "empty image");
  ImageView overlapping = picture.view();
  overlapping.stride = 5;
  check.asks(fmt::format("a view {} px wide in rows of 5 bytes", picture.width));
  check.refused_with(subject.finder().find(overlapping, box),
                     fmt::format("an image of {} pixels in rows of 5", picture.width));
}

}  // namespace

#define ARMATURE_LAW_ENTRY(Name, function, says) Law<LandmarkSubject>{#Name, says, &function},
std::span<const Law<LandmarkSubject>> landmark_laws() {
  static constexpr std::array kLaws{ARMATURE_LANDMARK_LAWS(ARMATURE_LAW_ENTRY)};
  return kLaws;
}

}  // namespace armature
