// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/detector/laws.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace armature {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// True, and the law is skipped, when nobody gave a picture.
bool lacks_face(const DetectorSubject& subject, LawCheck& check) {
  if (!subject.face) check.skip("no picture of a face was given");
  return !subject.face;
}

SearchRegion everywhere(const ImageView& view) {
  return {.box = {0, 0, view.width - 1.0, view.height - 1.0}};
}

std::string text(const PixelBox& box) {
  return fmt::format("a box of {} x {} px at ({}, {})", box.width, box.height, box.left, box.top);
}

/// The one face of `picture`, the subject's; nothing breaks the law.
std::optional<DetectedFace> only_face(const DetectorSubject& subject, const Picture& picture,
                                      LawCheck& check) {
  check.asks("the picture of one face, sought everywhere");
  const auto faces = subject.detector().detect(picture.view(), everywhere(picture.view()));
  if (!check.answered(faces, "the picture of one face")) return std::nullopt;
  if (!check.equal(faces->size(), 1u, "the number of faces in the picture of one")) {
    return std::nullopt;
  }
  return faces->front();
}

void expect_around_middle(const DetectorSubject& subject, const PixelBox& box, LawCheck& check) {
  const double x = subject.middle_x, y = subject.middle_y;
  check.that(box.left < x && x < box.right() && box.top < y && y < box.bottom(),
             fmt::format("{} holds the middle of the face, which is at ({}, {})", text(box), x, y));
}

void expect_same(const std::vector<DetectedFace>& a, const std::vector<DetectedFace>& b,
                 LawCheck& check) {
  if (!check.equal(a.size(), b.size(), "the number of faces")) return;
  for (std::size_t i = 0; i < a.size(); ++i) {
    check.equal(a[i].score, b[i].score, "the score of a face");
    check.equal(a[i].box.left, b[i].box.left, "the left side of a face's box [px]");
    check.equal(a[i].box.top, b[i].box.top, "the upper side of a face's box [px]");
    check.equal(a[i].box.width, b[i].box.width, "the width of a face's box [px]");
    check.equal(a[i].box.height, b[i].box.height, "the height of a face's box [px]");
  }
}

/// No faces are answered; false when there is no answer at all.
bool expect_none(const DetectorSubject& subject, const Picture& picture, const SearchRegion& region,
                 LawCheck& check) {
  const auto faces = subject.detector().detect(picture.view(), region);
  if (!check.answered(faces, "an image in which there is no face to find")) return false;
  check.equal(faces->size(), 0u, "the number of faces where there is none");
  return true;
}

void finds_face(const DetectorSubject& subject, LawCheck& check) {
  if (lacks_face(subject, check)) return;
  const Picture picture = subject.face();
  const auto face = only_face(subject, picture, check);
  if (!face) return;
  expect_around_middle(subject, face->box, check);
  check.that(std::isfinite(face->score), "the score is finite");
  check.that(face->box.width < picture.width,
             fmt::format("a face's box, {} px wide, is narrower than the picture, {} px",
                         face->box.width, picture.width));
}

void finds_in_region(const DetectorSubject& subject, LawCheck& check) {
  if (lacks_face(subject, check)) return;
  const Picture picture = subject.face();
  const auto face = only_face(subject, picture, check);
  if (!face) return;
  const PixelBox& box = face->box;
  check.asks(fmt::format("{}, faces about {} px wide", text(box.scaled(2)), box.width));
  const auto found =
      subject.detector().detect(picture.view(), {.box = box.scaled(2), .face_width = box.width});
  if (!check.answered(found, "a region around the face")) return;
  if (!check.equal(found->size(), 1u, "the number of faces in a region around one")) return;
  expect_around_middle(subject, found->front().box, check);
  check.near(found->front().box.width / box.width, 1, 0.3,
             "the width of the face found in the region, in widths of the face found before");
  const PixelBox aside{0, 0, box.left, picture.height - 1.0};
  check.asks(fmt::format("{}, faces about {} px wide", text(aside), box.width));
  expect_none(subject, picture, {.box = aside, .face_width = box.width}, check);
}

void finds_none_without_face(const DetectorSubject& subject, LawCheck& check) {
  for (const int grey : {0, 1, 128, 255}) {
    const Picture wall = Picture::of_one_grey(static_cast<std::uint8_t>(grey));
    check.asks(fmt::format("{} x {} pixels of grey {}", wall.width, wall.height, grey));
    if (!expect_none(subject, wall, everywhere(wall.view()), check)) return;
  }
  for (const std::uint64_t seed : {5u, 6u}) {
    const Picture noise = Picture::of_noise(seed);
    check.asks(fmt::format("{} x {} pixels of noise, seed {}", noise.width, noise.height, seed));
    if (!expect_none(subject, noise, everywhere(noise.view()), check)) return;
  }
}

void finds_none_in_small(const DetectorSubject& subject, LawCheck& check) {
  for (const auto& [width, height] : {std::pair{1, 1}, {3, 3}, {1, 400}, {400, 1}, {79, 79}}) {
    check.asks(fmt::format("{} x {} pixels of grey 100", width, height));
    const Picture small = Picture::of_one_grey(100, width, height);
    if (!expect_none(subject, small, everywhere(small.view()), check)) return;
  }
}

void repeats_bits(const DetectorSubject& subject, LawCheck& check) {
  if (lacks_face(subject, check)) return;
  FaceDetector& detector = subject.detector();
  const Picture face = subject.face(), noise = Picture::of_noise(1);
  check.asks("the picture of a face, noise of seed 1, the picture of the face again");
  const auto first = detector.detect(face.view(), everywhere(face.view()));
  static_cast<void>(detector.detect(noise.view(), everywhere(noise.view())));
  const auto second = detector.detect(face.view(), everywhere(face.view()));
  if (!check.answered(first, "a picture") || !check.answered(second, "the same picture")) return;
  expect_same(*second, *first, check);
}

void takes_longer_rows(const DetectorSubject& subject, LawCheck& check) {
  if (lacks_face(subject, check)) return;
  const Picture face = subject.face(), longer = face.with_longer_rows(37);
  check.asks(fmt::format("the picture, {} px wide, in rows of {}", face.width, longer.width));
  ImageView view = longer.view();
  view.width = face.width;
  const auto found = subject.detector().detect(view, everywhere(view));
  const auto same = subject.detector().detect(face.view(), everywhere(face.view()));
  if (!check.answered(found, "a picture in longer rows")) return;
  if (!check.answered(same, "the same picture in rows of its width")) return;
  expect_same(*found, *same, check);
}

void finds_none_in_no_region(const DetectorSubject& subject, LawCheck& check) {
  if (lacks_face(subject, check)) return;
  const Picture face = subject.face();
  const std::vector<PixelBox> boxes{{-1e6, 0, 50, 50},  {1e6, 1e6, 50, 50}, {10, 10, 0, 0},
                                    {0, 0, 1e-3, 1e-3}, {-50, 9000, 1, 1},  {10, 10, -30, -30},
                                    {kNan, 0, 50, 50},  {0, 0, kNan, 50}};
  for (const PixelBox& box : boxes) {
    for (const std::optional<double> width : {std::optional<double>{}, {100.0}, {0.0}, {kNan}}) {
      check.asks(text(box) +
                 (width ? fmt::format(", faces about {} px wide", *width) : ", faces of any size"));
      if (!expect_none(subject, face, {.box = box, .face_width = width}, check)) return;
    }
  }
}

void refuses_no_image(const DetectorSubject& subject, LawCheck& check) {
  const Picture picture = subject.face ? subject.face() : Picture::of_one_grey(100);
  const auto ask = [&](const ImageView& view) {
    return subject.detector().detect(view, everywhere(view));
  };
  check.asks("a view of no pixels");
  check.refused_with(ask({}), "empty image");
  ImageView overlapping = picture.view();
  overlapping.stride = 5;
  check.asks(fmt::format("a view {} px wide in rows of 5 bytes", picture.width));
  check.refused_with(ask(overlapping),
                     fmt::format("an image of {} pixels in rows of 5", picture.width));
}

}  // namespace

#define ARMATURE_LAW_ENTRY(Name, function, says) Law<DetectorSubject>{#Name, says, &function},
std::span<const Law<DetectorSubject>> detector_laws() {
  static constexpr std::array kLaws{ARMATURE_DETECTOR_LAWS(ARMATURE_LAW_ENTRY)};
  return kLaws;
}

}  // namespace armature
