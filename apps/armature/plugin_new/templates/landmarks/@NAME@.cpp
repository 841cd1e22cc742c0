#include <algorithm>
#include <cmath>

#include "@TARGET@_parameters.hpp"  // made from plugin.yaml
#include "armature/kinds/landmarks/landmarks.hpp"
#include "armature/runtime/plugins/plugin.hpp"

namespace @NAMESPACE@ {
namespace {

using Eigen::Vector2d;

/// The centre of what is darker than the mean within `reach` [px] of `at`; nothing dark: `at`.
Vector2d dark_centre(const ImageView& image, const Vector2d& at, const Vector2d& reach) {
  const auto inside = [](double x, int size) {
    return static_cast<int>(std::clamp(x, 0.0, size - 1.0));
  };
  const int left = inside(at.x() - reach.x(), image.width),
            right = inside(at.x() + reach.x(), image.width);
  const int top = inside(at.y() - reach.y(), image.height),
            bottom = inside(at.y() + reach.y(), image.height);
  const auto each_pixel = [&](auto&& do_this) {
    for (int v = top; v <= bottom; ++v) {
      for (int u = left; u <= right; ++u)
        do_this(
            Vector2d(u, v),
            image.data[static_cast<std::size_t>(v) * image.stride + static_cast<std::size_t>(u)]);
    }
  };
  double mean = 0, weight = 0;
  each_pixel([&](const Vector2d&, double grey) {
    mean += grey / ((right - left + 1.0) * (bottom - top + 1.0));
  });
  Vector2d sum = Vector2d::Zero();
  each_pixel([&](const Vector2d& pixel, double grey) {
    const double darkness = std::max(0.0, mean - grey);
    sum += darkness * pixel, weight += darkness;
  });
  return weight > 0 ? Vector2d{sum / weight} : at;
}

}  // namespace

class @CLASS@ final : public LandmarkFinder {
 public:
  explicit @CLASS@(const Params& params) : parameters_{Parameters::read(params)} {}

  LandmarkScheme scheme() const override { return LandmarkScheme::five; }
  Expected<std::vector<Landmark>> find(const ImageView& image, const PixelBox& face) override {
    if (auto wrong = invalid_input(image)) return refuse(*wrong);
    const Vector2d corner{face.left, face.top};
    const bool in_image = face.left > -face.width && face.left < image.width &&
                          face.top > -face.height && face.top < image.height;
    if (!(in_image && face.width >= 20 && face.width < 2 * image.width &&
          face.height < 2 * image.height))
      return refuse("the face's box is not in the picture, or narrower than 20 px");
    // In widths of the box that a detector gives: where eyes and mouth are, and how far they reach.
    const auto look = [&](double u, double v, double reach_u, double reach_v) {
      Vector2d at = corner + face.width * Vector2d{u, v};
      for (int i = 0; i < 10; ++i)
        at = dark_centre(image, at, face.width * Vector2d{reach_u, reach_v});
      return at;
    };
    const Vector2d left_eye = look(0.29, 0.26, 0.14, 0.08),
                   right_eye = look(0.71, 0.26, 0.14, 0.08);
    const Vector2d mouth = look(0.5, 0.71, 0.25, 0.08), aside = 0.3 * (right_eye - left_eye);
    const Vector2d nose = 0.25 * (left_eye + right_eye) + 0.5 * mouth;
    std::vector<Landmark> five;
    for (const Vector2d& point :
         {left_eye, right_eye, nose, Vector2d{mouth - aside}, Vector2d{mouth + aside}}) {
      five.push_back({.point = point, .sigma = parameters_.sigma});
    }
    return five;
  }

 private:
  Parameters parameters_;
};
}  // namespace @NAMESPACE@
ARMATURE_PLUGIN(@NAMESPACE@::@CLASS@);
