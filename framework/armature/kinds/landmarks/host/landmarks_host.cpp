// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdint>
#include <numeric>

#include "armature/kinds/landmarks/landmark_messages.hpp"
#include "armature/kinds/landmarks/landmarks.hpp"
#include "armature/runtime/component.hpp"
#include "armature/runtime/plugin.hpp"
#include "armature/runtime/setup.hpp"
#include "armature/values/guarded.hpp"

namespace armature {
namespace {

double mean_intensity(const ImageView& image) {
  std::uint64_t sum = 0;
  for (int v = 0; v < image.height; ++v) {
    const std::uint8_t* row = image.data + static_cast<std::size_t>(v) * image.stride;
    sum = std::accumulate(row, row + image.width, sum);
  }
  return static_cast<double>(sum) / (static_cast<double>(image.width) * image.height);
}

std::array<double, 4> box_of(const PixelBox& box) {
  return {box.left, box.top, box.width, box.height};
}

}  // namespace

/// Images in, landmarks out.
class LandmarksHost final : public Component {
 public:
  explicit LandmarksHost(Setup& setup)
      : Component{setup},
        finder_{setup.slot<LandmarkFinder>("landmarks")},
        left_image_{setup.input<msg::Image>("left_image")},
        right_image_{setup.input<msg::Image>("right_image")},
        landmarks_{setup.output<msg::FaceLandmarks>("landmarks")} {}

  void step(Time) override;

 private:
  static Expected<StereoLandmarks> find(LandmarkFinder& finder, const msg::Image& left,
                                        const msg::Image& right, LandmarkFinder::State& state);

  PluginPtr<LandmarkFinder> finder_;
  LandmarkFinder::State state_;
  Input<msg::Image> left_image_, right_image_;
  Output<msg::FaceLandmarks> landmarks_;
};

Expected<StereoLandmarks> LandmarksHost::find(LandmarkFinder& finder, const msg::Image& left,
                                              const msg::Image& right,
                                              LandmarkFinder::State& state) {
  const auto left_view = image_of(left), right_view = image_of(right);
  if (!left_view) return refuse("left: " + left_view.error().text);
  if (!right_view) return refuse("right: " + right_view.error().text);
  return guarded(state,
                 [&](LandmarkFinder::State& s) { return finder.find(*left_view, *right_view, s); });
}

void LandmarksHost::step(Time) {
  if (!left_image_.fresh() || !left_image_.latest() || !right_image_.latest()) return;
  const msg::Image& left = *left_image_.latest();
  const auto found = find(*finder_, left, *right_image_.latest(), state_);

  auto answer = landmarks_.loan();
  answer->header_() = left.header_();
  answer->valid_(found.has_value());
  answer->reason_(found ? std::string{} : found.error().text);
  const auto view = image_of(left);
  answer->image_intensity_(view ? mean_intensity(*view) : 0.0);
  answer->left_box_(box_of(found ? found->left.box : PixelBox{}));
  answer->right_box_(box_of(found ? found->right.box : PixelBox{}));
  answer->score_(found ? found->left.score : 0.0);
  answer->face_intensity_(found ? found->left.mean_intensity : 0.0);
  answer->left_().clear();
  answer->right_().clear();
  if (found) {
    assign(answer->left_(), found->left);
    assign(answer->right_(), found->right);
  }
  answer.publish();
}

}  // namespace armature

ARMATURE_PLUGIN(armature::LandmarksHost);
