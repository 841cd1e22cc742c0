// SPDX-License-Identifier: Apache-2.0
#include <dlib/image_processing/object_detector.h>
#include <dlib/image_processing/scan_fhog_pyramid.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "armature/kinds/detector/detector.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "detector_hog_parameters.hpp"
#include "dlib_chip.hpp"
#include "trained_detector.hpp"

namespace armature::detector::hog {
namespace {

using dlib_chip::Chip, dlib_chip::Image;

constexpr double kNativeFace = 80;   // [px] the detector's window
constexpr double kSearchFace = 120;  // [px] the face of a known width in the picture searched
constexpr double kMaxScale = 6;      // chip pixels per image pixel: a face of 20 px

/// The part of `box` that lies in the image, in whole pixels.
PixelBox clipped(const PixelBox& box, const ImageView& image) {
  const double u_max = image.width - 1, v_max = image.height - 1;
  const double left = std::clamp(std::floor(box.left), 0.0, u_max);
  const double top = std::clamp(std::floor(box.top), 0.0, v_max);
  const double right = std::clamp(std::ceil(box.right()), left, u_max);
  const double bottom = std::clamp(std::ceil(box.bottom()), top, v_max);
  return {left, top, right - left, bottom - top};
}

/// dlib's frontal_face_detector.
using Detector = dlib::object_detector<dlib::scan_fhog_pyramid<dlib::pyramid_down<6>>>;

/// The detector that dlib ships, read once for the process.
const Detector& trained_detector() {
  static const Detector detector = [] {
    Detector read;
    std::istringstream stream{std::string{kTrainedDetector}};
    dlib::deserialize(read, stream);
    return read;
  }();
  return detector;
}

}  // namespace

/// dlib's frontal face detector (see README).
class Hog final : public FaceDetector {
 public:
  explicit Hog(const Parameters& parameters) : parameters_{parameters} {}
  static Expected<std::unique_ptr<FaceDetector>> make(const Params& params) {
    return std::make_unique<Hog>(Parameters::read(params));
  }

  Expected<std::vector<DetectedFace>> detect(const ImageView& image,
                                             const SearchRegion& region) override;

 private:
  Detector detector_ = trained_detector();
  Parameters parameters_;
};

Expected<std::vector<DetectedFace>> Hog::detect(const ImageView& image,
                                                const SearchRegion& region) {
  if (auto wrong = invalid_input(image)) return refuse(*wrong);
  const double scale = region.face_width
                           ? std::clamp(kSearchFace / *region.face_width, 0.0, kMaxScale)
                           : std::max(1.0, kNativeFace / parameters_.min_face);
  const PixelBox part = clipped(region.box, image);
  std::vector<DetectedFace> faces;
  // Written so that a box that is not finite has no face either.
  if (!(part.width * scale >= kNativeFace && part.height * scale >= kNativeFace)) return faces;
  const Chip chip = dlib_chip::cut(dlib_chip::copied(image), part, scale);
  std::vector<dlib::rect_detection> found;
  detector_(chip.image, found, parameters_.threshold);
  for (const auto& detection : found) {
    const dlib::drectangle r{detection.rect};
    const dlib::dpoint tl = chip.image_T_chip(r.tl_corner()), br = chip.image_T_chip(r.br_corner());
    const dlib::drectangle box{tl, br};
    faces.push_back({.box = {box.left(), box.top(), box.width(), box.height()},
                     .score = detection.detection_confidence});
  }
  return faces;
}

}  // namespace armature::detector::hog

ARMATURE_PLUGIN(armature::detector::hog::Hog);
