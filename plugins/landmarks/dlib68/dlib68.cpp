// SPDX-License-Identifier: Apache-2.0
// The only file that sees dlib: it takes 15 s to compile.
#include <dlib/image_processing.h>
#include <dlib/image_processing/frontal_face_detector.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <numeric>

#include "armature/kinds/landmarks/landmarks.hpp"
#include "armature/runtime/plugin.hpp"
#include "landmarks_dlib68_parameters.hpp"

namespace armature::landmarks::dlib68 {
namespace {

using Image = dlib::array2d<unsigned char>;

constexpr double kNativeFace = 80;    // [px] the detector's window
constexpr double kSearchScale = 2.0;  // searched first: the last box, this much larger
constexpr double kSearchFace = 120;   // [px] width of the last box in the picture that is searched
constexpr double kMostEnlarged = 6;   // chip pixels per image pixel: a face of 20 px
constexpr double kLandmarkScale = 1.4;  // landmarks are sought in the box, this much larger
constexpr double kStripSlack = 0.35;    // of the box height: rows searched above and below
constexpr double kMostDisparity = 1.6;  // of the box width: columns searched to the left
constexpr std::size_t kGreyValues = 256;

/// A part of an image, resampled, and the way back.
struct Chip {
  Image image;
  dlib::point_transform_affine image_T_chip, chip_T_image;
};

PixelBox scaled(const PixelBox& box, double factor) {
  return {box.left - 0.5 * (factor - 1) * box.width, box.top - 0.5 * (factor - 1) * box.height,
          factor * box.width, factor * box.height};
}

dlib::drectangle rectangle(const PixelBox& box) {
  return {box.left, box.top, box.left + box.width, box.top + box.height};
}

PixelBox pixel_box(const dlib::drectangle& r) { return {r.left(), r.top(), r.width(), r.height()}; }

Chip cut(const Image& image, const dlib::chip_details& details) {
  Chip chip;
  dlib::extract_image_chip(image, details, chip.image, dlib::interpolate_bilinear());
  chip.chip_T_image = dlib::get_mapping_to_chip(details);
  chip.image_T_chip = dlib::inv(chip.chip_T_image);
  return chip;
}

/// `box` resampled to `scale` chip pixels per image pixel.
Chip cut(const Image& image, const PixelBox& box, double scale) {
  const auto size = [&](double length) {
    return static_cast<unsigned long>(std::lround(length * scale)) + 1;
  };
  return cut(image, dlib::chip_details{rectangle(box),
                                       dlib::chip_dims{size(box.height), size(box.width)}});
}

PixelBox clipped(const PixelBox& box, long image_width, long image_height) {
  const auto u_max = static_cast<double>(image_width - 1);
  const auto v_max = static_cast<double>(image_height - 1);
  const double left = std::clamp(std::floor(box.left), 0.0, u_max);
  const double top = std::clamp(std::floor(box.top), 0.0, v_max);
  const double right = std::clamp(std::ceil(box.left + box.width), left, u_max);
  const double bottom = std::clamp(std::ceil(box.top + box.height), top, v_max);
  return {left, top, right - left, bottom - top};
}

Image copied(const ImageView& view) {
  Image image(view.height, view.width);
  for (int v = 0; v < view.height; ++v) {
    const std::uint8_t* row = view.data + static_cast<std::size_t>(v) * view.stride;
    std::copy(row, row + view.width, &image[v][0]);
  }
  return image;
}

/// Mean grey value inside `box`.
double mean_intensity(const ImageView& view, const PixelBox& box) {
  const PixelBox inside = clipped(box, view.width, view.height);
  const auto left = static_cast<std::size_t>(inside.left),
             top = static_cast<std::size_t>(inside.top);
  const auto width = static_cast<std::size_t>(inside.width) + 1;
  const auto height = static_cast<std::size_t>(inside.height) + 1;
  double sum = 0;
  for (std::size_t v = top; v < top + height; ++v) {
    const std::uint8_t* from = view.data + v * view.stride + left;
    sum += static_cast<double>(std::accumulate(from, from + width, std::uint64_t{0}));
  }
  return sum / static_cast<double>(width * height);
}

/// Stretches the grey values between the 0.5 and 99.5 percentiles to 0..255 when the image's
/// brightest part is darker than `below`: the detector was trained on pictures of normal light.
void stretch_if_dark(Image& image, double below) {
  std::array<long, kGreyValues> count{};
  for (const unsigned char value : image) ++count[value];
  const auto percentile = [&](double share) {
    long left = static_cast<long>(share * static_cast<double>(image.size()));
    std::size_t value = 0;
    while (value + 1 < kGreyValues && (left -= count[value]) >= 0) ++value;
    return static_cast<double>(value);
  };
  const double low = percentile(0.005), high = percentile(0.995);
  if (high >= below || high - low < 4) return;
  std::array<unsigned char, kGreyValues> table{};
  for (std::size_t i = 0; i < kGreyValues; ++i) {
    const double value = 255 * (static_cast<double>(i) - low) / (high - low);
    table[i] = static_cast<unsigned char>(std::lround(std::clamp(value, 0.0, 255.0)));
  }
  for (unsigned char& value : image) value = table[value];
}

}  // namespace

/// HOG frontal face detector and the 68-landmark regression trees of dlib (see README).
class Dlib68 final : public LandmarkFinder {
 public:
  explicit Dlib68(const Parameters& parameters) : parameters_{parameters} {}
  static Expected<std::unique_ptr<LandmarkFinder>> make(const Params& params);

  Expected<StereoLandmarks> find(const ImageView& left, const ImageView& right,
                                 State& state) override;

 private:
  struct Face {
    PixelBox box;
    double score = 0;
  };
  std::optional<Face> detect_in(const Image& image, const PixelBox& where, double scale);
  std::optional<Face> detect_near(const Image& image, const PixelBox& last);
  std::optional<Face> detect_anywhere(const Image& image);
  std::optional<Face> detect_right(const Image& image, const State& state, const PixelBox& left);
  FaceLandmarks landmarks(const Image& image, const Face& face) const;
  void add_landmarks(const Chip& chip, const PixelBox& box, FaceLandmarks& sum) const;

  dlib::frontal_face_detector detector_ = dlib::get_frontal_face_detector();
  dlib::shape_predictor predictor_;
  Parameters parameters_;
};

Expected<std::unique_ptr<LandmarkFinder>> Dlib68::make(const Params& params) {
  auto finder = std::make_unique<Dlib68>(Parameters::read(params));
  const std::string& model = finder->parameters_.model;
  const std::string hint =
      "; the Debian package libdlib-data installs it as "
      "/usr/share/dlib/shape_predictor_68_face_landmarks.dat";
  if (!std::ifstream{model}) return refuse("cannot open the landmark model " + model + hint);
  try {
    dlib::deserialize(model) >> finder->predictor_;
  } catch (const std::exception& error) {
    return refuse(model + " is not a landmark model of dlib (" + error.what() + ")" + hint);
  }
  if (finder->predictor_.num_parts() != FaceLandmarks::kCount) {
    return refuse(model + " has " + std::to_string(finder->predictor_.num_parts()) +
                  " landmarks, not 68" + hint);
  }
  return finder;
}

Expected<StereoLandmarks> Dlib68::find(const ImageView& left, const ImageView& right,
                                       State& state) {
  if (auto wrong = invalid_input(left, right)) return refuse(*wrong);
  Image left_image = copied(left), right_image = copied(right);
  stretch_if_dark(left_image, parameters_.stretch_below);
  stretch_if_dark(right_image, parameters_.stretch_below);

  std::optional<Face> left_face;
  if (state.left) left_face = detect_near(left_image, *state.left);
  if (!left_face) left_face = detect_anywhere(left_image);
  if (!left_face) {
    state = {};
    return refuse("no face in the left image");
  }
  state.left = left_face->box;

  const std::optional<Face> right_face = detect_right(right_image, state, left_face->box);
  if (!right_face) {
    state.right.reset();
    return refuse("no face in the right image");
  }
  state.right = right_face->box;

  StereoLandmarks found{landmarks(left_image, *left_face), landmarks(right_image, *right_face)};
  found.left.mean_intensity = mean_intensity(left, found.left.box);
  found.right.mean_intensity = mean_intensity(right, found.right.box);
  return found;
}

std::optional<Dlib68::Face> Dlib68::detect_in(const Image& image, const PixelBox& where,
                                              double scale) {
  const PixelBox part = clipped(where, image.nc(), image.nr());
  if (part.width * scale < kNativeFace || part.height * scale < kNativeFace) return {};
  const Chip chip = cut(image, part, scale);
  std::vector<dlib::rect_detection> found;
  detector_(chip.image, found, parameters_.threshold);
  if (found.empty()) return {};
  const auto& best = *std::max_element(found.begin(), found.end(), [](auto& a, auto& b) {
    return a.detection_confidence < b.detection_confidence;
  });
  const dlib::drectangle r{best.rect};
  const dlib::dpoint tl = chip.image_T_chip(r.tl_corner()), br = chip.image_T_chip(r.br_corner());
  return Face{pixel_box(dlib::drectangle{tl, br}), best.detection_confidence};
}

std::optional<Dlib68::Face> Dlib68::detect_near(const Image& image, const PixelBox& last) {
  return detect_in(image, scaled(last, kSearchScale),
                   std::min(kSearchFace / last.width, kMostEnlarged));
}

std::optional<Dlib68::Face> Dlib68::detect_anywhere(const Image& image) {
  const PixelBox all{0, 0, static_cast<double>(image.nc() - 1),
                     static_cast<double>(image.nr() - 1)};
  return detect_in(image, all, std::max(1.0, kNativeFace / parameters_.least_face));
}

// The pair is rectified: the right image has the face in the same rows, further left.
std::optional<Dlib68::Face> Dlib68::detect_right(const Image& image, const State& state,
                                                 const PixelBox& left) {
  std::optional<Face> face;
  if (state.right) face = detect_near(image, *state.right);
  if (!face) {
    const PixelBox strip{left.left - kMostDisparity * left.width,
                         left.top - kStripSlack * left.height, (kMostDisparity + 1.2) * left.width,
                         (1 + 2 * kStripSlack) * left.height};
    face = detect_in(image, strip, kSearchFace / left.width);
  }
  if (!face) face = detect_anywhere(image);
  return face;
}

// dlib rounds landmarks to whole pixels and samples the image at whole pixels. On a chip in which
// the face is `landmark_face_px` wide that rounding is a fraction of an image pixel; the mean over
// `boxes` shifted and scaled boxes removes most of what depends on the detector's coarse box.
FaceLandmarks Dlib68::landmarks(const Image& image, const Face& face) const {
  const double scale = parameters_.landmark_face / face.box.width;
  const Chip chip = cut(image, scaled(face.box, kLandmarkScale), scale);
  FaceLandmarks sum;
  sum.points.fill(Eigen::Vector2d::Zero());
  sum.box = face.box;
  sum.score = face.score;

  constexpr double kShift = 0.04, kGolden = 2.399963229728653;  // of the box; [rad]
  const int boxes = parameters_.boxes;
  for (int i = 0; i < boxes; ++i) {
    // Points of a sunflower disc around the box: even cover for any number of them.
    const double radius = boxes == 1 ? 0 : kShift * std::sqrt((i + 0.5) / boxes) * 1.5;
    const double size = boxes == 1 ? 1 : 0.94 + 0.12 * (i * 7 % boxes) / (boxes - 1.0);
    PixelBox box = scaled(face.box, size);
    box.left += radius * std::cos(i * kGolden) * box.width;
    box.top += radius * std::sin(i * kGolden) * box.height;
    add_landmarks(chip, box, sum);
  }
  for (Eigen::Vector2d& point : sum.points) point /= boxes;
  return sum;
}

void Dlib68::add_landmarks(const Chip& chip, const PixelBox& box, FaceLandmarks& sum) const {
  const dlib::drectangle r = rectangle(box);
  const dlib::rectangle in_chip{
      dlib::drectangle{chip.chip_T_image(r.tl_corner()), chip.chip_T_image(r.br_corner())}};
  const dlib::full_object_detection shape = predictor_(chip.image, in_chip);
  for (unsigned long i = 0; i < FaceLandmarks::kCount; ++i) {
    const dlib::dpoint p = chip.image_T_chip(dlib::dpoint{shape.part(i)});
    sum.points[i] += Eigen::Vector2d{p.x(), p.y()};
  }
}

}  // namespace armature::landmarks::dlib68

ARMATURE_PLUGIN(armature::landmarks::dlib68::Dlib68);
