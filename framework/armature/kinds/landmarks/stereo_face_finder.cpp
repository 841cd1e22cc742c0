// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/landmarks/stereo_face_finder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "armature/kinds/landmarks/stretched_image.hpp"

namespace armature {
namespace {

constexpr double kSearchScale = 2.0;    // the last box, this much larger, is searched first
constexpr double kStripSlack = 0.35;    // of the box height: rows searched above and below
constexpr double kMaxDisparity = 1.6;   // of the box width: columns searched to the left
constexpr double kCoarseness = 0.15;    // of the box width: by which a detector's box may be aside
constexpr double kMaxWidthRatio = 1.3;  // of the boxes of one face: a step of detectors is 1.2
constexpr double kStep = 0.2;           // of the box width: by which boxes of one face may differ
constexpr double kSameRows = 0.03;      // of the box width: landmarks of one face are so near

/// Why the views are no stereo pair.
std::optional<std::string> no_pair(const ImageView& left, const ImageView& right) {
  for (const ImageView* view : {&left, &right}) {
    if (auto wrong = invalid_input(*view)) return wrong;
  }
  if (left.width == right.width && left.height == right.height) return std::nullopt;
  const auto size = [](const ImageView& view) {
    return std::to_string(view.width) + " x " + std::to_string(view.height);
  };
  return "the left image is " + size(left) + " pixels, the right one " + size(right);
}

bool is_sound(const PixelBox& box) {
  return std::isfinite(box.left) && std::isfinite(box.top) && std::isfinite(box.width) &&
         std::isfinite(box.height) && box.width > 0 && box.height > 0;
}

Eigen::Vector2d centre(const PixelBox& box) {
  return {box.left + 0.5 * box.width, box.top + 0.5 * box.height};
}

/// The distance of two boxes: between their centres and in width [px].
double distance(const PixelBox& a, const PixelBox& b) {
  return (centre(a) - centre(b)).norm() + std::abs(a.width - b.width);
}

// What a face costs as a choice; no face that costs infinitely much is chosen.
constexpr double kImpossible = std::numeric_limits<double>::infinity();

/// By how much two boxes of a pair differ where those of one face do not: in rows and in width
/// [px]. A face is never further right in the right picture.
double difference(const PixelBox& in_right, const PixelBox& in_left) {
  const Eigen::Vector2d aside = centre(in_right) - centre(in_left);
  if (aside.x() > kCoarseness * in_left.width) return kImpossible;
  return std::abs(aside.y()) + std::abs(in_right.width - in_left.width);
}

/// Whether boxes of a pair that is rectified can be of one face.
bool can_be_one_face(const PixelBox& in_right, const PixelBox& in_left) {
  const double ratio = in_right.width / in_left.width;
  return difference(in_right, in_left) < kImpossible && ratio < kMaxWidthRatio &&
         ratio > 1 / kMaxWidthRatio &&
         std::abs(centre(in_right).y() - centre(in_left).y()) < kStripSlack * in_left.height;
}

/// The mean difference in rows of the landmarks of two boxes [px]; infinite
/// where those of the right picture are not further left.
double row_difference(const std::vector<Landmark>& in_right, const std::vector<Landmark>& in_left) {
  double rows = 0, columns = 0;
  for (std::size_t i = 0; i < in_left.size(); ++i) {
    const Eigen::Vector2d apart = in_right[i].point - in_left[i].point;
    rows += std::abs(apart.y());
    columns += apart.x();
  }
  return columns < 0 ? rows / static_cast<double>(in_left.size()) : kImpossible;
}

/// The rows and columns of the right picture where the face must be that the left one has so.
PixelBox strip_of(const PixelBox& in_left) {
  return {in_left.left - kMaxDisparity * in_left.width, in_left.top - kStripSlack * in_left.height,
          (kMaxDisparity + 1.2) * in_left.width, (1 + 2 * kStripSlack) * in_left.height};
}

/// The box as far on the other side of `in_left`.
PixelBox mirrored(PixelBox box, const PixelBox& in_left) {
  box.left = 2 * in_left.left + in_left.width - box.right();
  return box;
}

/// Moves the face's box as its landmarks have moved and grown since the last pair.
void follow(const FaceLandmarks& found, StereoFaceFinder::State::Face& face) {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const Landmark& landmark : found.points) middle += landmark.point;
  middle /= static_cast<double>(found.points.size());
  double spread = 0;
  for (const Landmark& landmark : found.points) spread += (landmark.point - middle).norm();
  if (face.spread > 0) {
    PixelBox& box = face.where.box;
    box = box.scaled(spread / face.spread);
    box.left += middle.x() - face.middle.x();
    box.top += middle.y() - face.middle.y();
  }
  face.middle = middle;
  face.spread = spread;
}

}  // namespace

PixelBox whole(const ImageView& image) {
  return {0, 0, static_cast<double>(image.width - 1), static_cast<double>(image.height - 1)};
}

double mean_intensity(const ImageView& image, const PixelBox& box) {
  const auto pixel = [](double at, int size) { return std::clamp(at, 0.0, size - 1.0); };
  const auto left = static_cast<std::size_t>(pixel(std::floor(box.left), image.width));
  const auto top = static_cast<std::size_t>(pixel(std::floor(box.top), image.height));
  const auto right = static_cast<std::size_t>(pixel(std::ceil(box.right()), image.width));
  const auto bottom = static_cast<std::size_t>(pixel(std::ceil(box.bottom()), image.height));
  double sum = 0;
  for (std::size_t v = top; v <= bottom; ++v) {
    const std::uint8_t* row = image.data + v * image.stride;
    sum += static_cast<double>(std::accumulate(row + left, row + right + 1, std::uint64_t{0}));
  }
  return sum / static_cast<double>((right - left + 1) * (bottom - top + 1));
}

Expected<StereoLandmarks> StereoFaceFinder::find(const ImageView& left, const ImageView& right,
                                                 State& state) {
  if (auto wrong = no_pair(left, right)) return refuse(*wrong);
  const ImageView left_image = stretched_if_dark(left, options_.stretch_below, left_pixels_);
  const ImageView right_image = stretched_if_dark(right, options_.stretch_below, right_pixels_);
  const bool is_followed =
      state.left && state.right && state.pairs_since + 1 < options_.detect_every;
  if (is_followed) {
    ++state.pairs_since;
  } else if (auto missing = detect_both(left_image, right_image, state)) {
    return tl::unexpected{*missing};
  }
  auto of_left = landmarks(left, left_image, *state.left);
  if (!of_left) return refuse("left: " + of_left.error().text);
  auto of_right = landmarks(right, right_image, *state.right);
  if (!of_right) return refuse("right: " + of_right.error().text);
  return StereoLandmarks{std::move(*of_left), std::move(*of_right)};
}

/// Why there is no face in both pictures, or nothing: then the state has them.
std::optional<Reason> StereoFaceFinder::detect_both(const ImageView& left, const ImageView& right,
                                                    State& state) {
  const State last = std::exchange(state, {});
  const auto box = [](const std::optional<State::Face>& face) {
    return face ? std::optional{face->where.box} : std::nullopt;
  };
  const Faces in_left = find_left(left, box(last.left));
  if (!in_left) return in_left.error();
  // A pair that misses the face in the left picture leaves it there for the next one.
  const bool is_kept =
      last.left && last.right &&
      (!*in_left || distance((*in_left)->box, last.left->where.box) > last.left->where.box.width);
  if (is_kept) state.left = last.left;
  if (!*in_left) return Reason{"no face in the left image"};
  if (is_kept) return Reason{"the face is not in the left image, another one is"};
  state.left = State::Face{.where = **in_left};
  const Faces in_right = find_right(right, box(last.right), left, state.left->where.box);
  if (!in_right) return in_right.error();
  if (!*in_right) {
    const Faces aside = find_on_wrong_side(right, state.left->where.box);
    if (!aside) return aside.error();
    return Reason{*aside
                      ? "a face is in both pictures, but on the wrong side: are the left and the "
                        "right camera exchanged?"
                      : "no face in the right image"};
  }
  state.right = State::Face{.where = **in_right};
  return std::nullopt;
}

StereoFaceFinder::Faces StereoFaceFinder::find_left(const ImageView& left,
                                                    const std::optional<PixelBox>& last) {
  if (last) {
    const auto to_last = [&](const PixelBox& face) { return distance(face, *last); };
    const Faces near =
        detect(left, {.box = last->scaled(kSearchScale), .face_width = last->width}, to_last);
    if (!near || *near) return near;
    return detect(left, {.box = whole(left)}, to_last);
  }
  const auto by_size = [](const PixelBox& face) { return -face.width; };
  return detect(left, {.box = whole(left)}, by_size);
}

// The pair is rectified: the right picture has the face in the same rows, further left.
StereoFaceFinder::Faces StereoFaceFinder::find_right(const ImageView& right,
                                                     const std::optional<PixelBox>& last,
                                                     const ImageView& left,
                                                     const PixelBox& in_left) {
  if (last) {
    const auto to_last = [&](const PixelBox& face) {
      return can_be_one_face(face, in_left) ? distance(face, *last) : kImpossible;
    };
    const Faces near =
        detect(right, {.box = last->scaled(kSearchScale), .face_width = last->width}, to_last);
    if (!near || *near) return near;
  }
  const auto to_left = [&](const PixelBox& face) { return difference(face, in_left); };
  std::optional<DetectedFace> likely;
  double likely_rows = kImpossible;
  for (const SearchRegion& region :
       {SearchRegion{strip_of(in_left), in_left.width}, SearchRegion{whole(right), std::nullopt}}) {
    const auto faces = detect_all(right, region, to_left);
    if (!faces) return tl::unexpected{faces.error()};
    if (faces->empty()) continue;
    const auto [face, rows] = most_alike(right, *faces, left, in_left);
    if (!likely || rows < likely_rows) {
      likely = face;
      likely_rows = rows;
    }
    if (rows < kSameRows * in_left.width) break;
  }
  return likely;
}

/// Finds, among faces in the right picture whose boxes cannot be told apart (least cost first), the
/// one whose landmarks lie in the rows of the left face's, and by how much those differ [px].
std::pair<DetectedFace, double> StereoFaceFinder::most_alike(const ImageView& right,
                                                             const std::vector<DetectedFace>& faces,
                                                             const ImageView& left,
                                                             const PixelBox& in_left) {
  std::pair<DetectedFace, double> best{faces.front(), kImpossible};
  const auto of_left = landmarks_.find(left, in_left);
  const double least = difference(faces.front().box, in_left);
  for (const DetectedFace& face : faces) {
    if (!of_left || difference(face.box, in_left) > least + kStep * in_left.width) break;
    const auto of_right = landmarks_.find(right, face.box);
    if (!of_right || of_right->size() != of_left->size()) continue;
    const double rows = row_difference(*of_right, *of_left);
    if (rows < best.second) best = {face, rows};
  }
  return best;
}

// Where the pictures are exchanged the same face is as far to the right as it should be to the
// left.
StereoFaceFinder::Faces StereoFaceFinder::find_on_wrong_side(const ImageView& right,
                                                             const PixelBox& in_left) {
  const auto to_left = [&](const PixelBox& face) {
    const PixelBox should_be = mirrored(face, in_left);
    return can_be_one_face(should_be, in_left) ? difference(should_be, in_left) : kImpossible;
  };
  return detect(right, {.box = mirrored(strip_of(in_left), in_left), .face_width = in_left.width},
                to_left);
}

/// The face that costs least; nothing when there is none that is possible.
StereoFaceFinder::Faces StereoFaceFinder::detect(const ImageView& image, const SearchRegion& region,
                                                 const Cost& cost) {
  return detect_all(image, region, cost).map([](const std::vector<DetectedFace>& faces) {
    return faces.empty() ? std::nullopt : std::optional{faces.front()};
  });
}

/// All that are possible, least cost first.
Expected<std::vector<DetectedFace>> StereoFaceFinder::detect_all(const ImageView& image,
                                                                 const SearchRegion& region,
                                                                 const Cost& cost) {
  auto faces = detector_.detect(image, region);
  if (!faces) return tl::unexpected{faces.error()};
  std::erase_if(*faces, [&](const DetectedFace& face) {
    return !is_sound(face.box) || cost(face.box) == kImpossible;
  });
  std::ranges::stable_sort(*faces, {}, [&](const DetectedFace& face) { return cost(face.box); });
  return faces;
}

Expected<FaceLandmarks> StereoFaceFinder::landmarks(const ImageView& original,
                                                    const ImageView& stretched, State::Face& face) {
  auto points = landmarks_.find(stretched, face.where.box);
  if (!points) return tl::unexpected{points.error()};
  if (points->size() != landmark_count(landmarks_.scheme())) {
    return refuse(std::to_string(points->size()) + " landmarks, and " +
                  std::string{to_string(landmarks_.scheme())} + " has " +
                  std::to_string(landmark_count(landmarks_.scheme())));
  }
  FaceLandmarks found{.scheme = landmarks_.scheme(),
                      .points = std::move(*points),
                      .box = face.where.box,
                      .score = face.where.score,
                      .mean_intensity = mean_intensity(original, face.where.box)};
  follow(found, face);
  return found;
}

}  // namespace armature
