// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>

#include "armature/kinds/landmarks/landmarks.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "cascade.hpp"
#include "dlib_chip.hpp"
#include "landmarks_dlib68_parameters.hpp"
#include "numbers_file.hpp"

namespace armature::landmarks::dlib68 {
namespace {

using dlib_chip::Chip;

constexpr double kChipScale = 1.4;  // landmarks are sought in the box, this much larger

using Model = std::shared_ptr<const Cascade>;

/// The model of a file, which is read once for all finders of the process that live at a time.
/// Throws what dlib throws.
Model model_of(const std::string& file) {
  static std::mutex mutex;
  static std::map<std::string, std::weak_ptr<const Cascade>> models;
  const std::lock_guard lock{mutex};
  std::weak_ptr<const Cascade>& model = models[file];
  if (Model known = model.lock()) return known;
  NumbersFile numbers{file};
  std::istream in{&numbers};
  auto read = std::make_shared<const Cascade>(Cascade::read(in));
  model = read;
  return read;
}

}  // namespace

/// The 68-landmark regression trees of dlib (see README).
class Dlib68 final : public LandmarkFinder {
 public:
  explicit Dlib68(const Parameters& parameters) : parameters_{parameters} {}
  static Expected<std::unique_ptr<LandmarkFinder>> make(const Params& params);

  LandmarkScheme scheme() const override { return LandmarkScheme::ibug68; }
  Expected<std::vector<Landmark>> find(const ImageView& image, const PixelBox& face) override;

 private:
  void add_landmarks(const Chip& chip, const PixelBox& box, std::vector<Landmark>& sum) const;

  Model model_;
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
    finder->model_ = model_of(model);
  } catch (const std::exception& error) {
    return refuse(model + " is not a landmark model of dlib (" + error.what() + ")" + hint);
  }
  if (finder->model_->landmarks() != landmark_count(LandmarkScheme::ibug68)) {
    return refuse(model + " has " + std::to_string(finder->model_->landmarks()) +
                  " landmarks, not 68" + hint);
  }
  return finder;
}

// The trees sample the image at whole pixels. On a chip in which the face is `face_width_px` wide
// such a pixel is a fraction of an image pixel; the mean over `boxes` shifted and scaled boxes
// removes most of what depends on the detector's coarse box.
Expected<std::vector<Landmark>> Dlib68::find(const ImageView& image, const PixelBox& face) {
  if (auto wrong = invalid_input(image)) return refuse(*wrong);
  if (auto wrong = invalid_input(face)) return refuse(*wrong);
  const double scale = parameters_.face_width / face.width;
  const Chip chip = dlib_chip::cut(dlib_chip::copied(image), face.scaled(kChipScale), scale);
  std::vector<Landmark> sum(landmark_count(scheme()),
                            {.point = Eigen::Vector2d::Zero(), .sigma = parameters_.sigma});

  constexpr double kShift = 0.04, kGolden = 2.399963229728653;  // of the box; [rad]
  const int boxes = parameters_.boxes;
  for (int i = 0; i < boxes; ++i) {
    // Points of a sunflower disc around the box: even cover for any number of them.
    const double radius = boxes == 1 ? 0 : kShift * std::sqrt((i + 0.5) / boxes) * 1.5;
    const double size = boxes == 1 ? 1 : 0.94 + 0.12 * (i * 7 % boxes) / (boxes - 1.0);
    PixelBox box = face.scaled(size);
    box.left += radius * std::cos(i * kGolden) * box.width;
    box.top += radius * std::sin(i * kGolden) * box.height;
    add_landmarks(chip, box, sum);
  }
  for (Landmark& landmark : sum) landmark.point /= boxes;
  return sum;
}

void Dlib68::add_landmarks(const Chip& chip, const PixelBox& box,
                           std::vector<Landmark>& sum) const {
  const dlib::drectangle r = dlib_chip::rectangle(box);
  const dlib::rectangle in_chip{
      dlib::drectangle{chip.chip_T_image(r.tl_corner()), chip.chip_T_image(r.br_corner())}};
  const std::vector<Eigen::Vector2d> found = model_->find(chip.image, in_chip);
  for (std::size_t i = 0; i < sum.size(); ++i) {
    const dlib::dpoint p = chip.image_T_chip(dlib::dpoint{found[i].x(), found[i].y()});
    sum[i].point += Eigen::Vector2d{p.x(), p.y()};
  }
}

}  // namespace armature::landmarks::dlib68

ARMATURE_PLUGIN(armature::landmarks::dlib68::Dlib68);
