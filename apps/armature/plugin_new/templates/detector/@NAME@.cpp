#include <algorithm>
#include <array>
#include <cmath>

#include "@TARGET@_parameters.hpp"  // made from plugin.yaml
#include "armature/kinds/detector/detector.hpp"
#include "armature/runtime/plugins/plugin.hpp"

namespace @NAMESPACE@ {
/// One blob, from the moments of its pixels: an ellipse is two standard deviations wide and high.
class @CLASS@ final : public FaceDetector {
 public:
  explicit @CLASS@(const Params& params) : parameters_{Parameters::read(params)} {}

  Expected<std::vector<DetectedFace>> detect(const ImageView& image,
                                             const SearchRegion& region) override {
    if (auto wrong = invalid_input(image)) return refuse(*wrong);
    // A box that is not finite begins and ends at 0.
    const auto inside = [](double at, int size) {
      return at > 0 ? static_cast<int>(std::min<double>(at, size)) : 0;
    };
    const int left = inside(region.box.left, image.width),
              right = inside(region.box.right() + 1, image.width);
    const int top = inside(region.box.top, image.height),
              bottom = inside(region.box.bottom() + 1, image.height);
    const auto each_pixel = [&](auto&& do_this) {
      for (int v = top; v < bottom; ++v) {
        for (int u = left; u < right; ++u)
          do_this(
              u, v,
              image.data[static_cast<std::size_t>(v) * image.stride + static_cast<std::size_t>(u)]);
      }
    };
    std::array<int, 256> count{};
    each_pixel([&](int, int, std::uint8_t value) { ++count[value]; });
    int grey = 255, brighter = 0;
    while (grey > 0 && 100 * (brighter += count[static_cast<std::size_t>(grey)]) <
                           (right - left) * (bottom - top))
      --grey;

    double n = 0, u1 = 0, v1 = 0, u2 = 0, v2 = 0;
    each_pixel([&](double u, double v, std::uint8_t value) {
      if (value > parameters_.bright_share * grey)
        n += 1, u1 += u, v1 += v, u2 += u * u, v2 += v * v;
    });
    if (n == 0) return std::vector<DetectedFace>{};
    const double mean_u = u1 / n, mean_v = v1 / n;
    const double rx = 2 * std::sqrt(std::max(0.0, u2 / n - mean_u * mean_u)),
                 ry = 2 * std::sqrt(std::max(0.0, v2 / n - mean_v * mean_v));
    const bool whole =
        mean_u - rx > left && mean_u + rx < right && mean_v - ry > top && mean_v + ry < bottom;
    const double filled =
        n / (4 * rx * ry);  // of an ellipse 0.79; of noise what part of it is bright
    if (!whole || !(filled > 0.4)) return std::vector<DetectedFace>{};
    // Skin is darker at its edge. A box goes from the brows to the chin: so landmarks are looked
    // for.
    const double half = 1.3 * rx;
    return std::vector<DetectedFace>{
        {.box = {mean_u - half, mean_v - 1.1 * rx, 2 * half, 2 * half}, .score = filled}};
  }

 private:
  Parameters parameters_;
};
}  // namespace @NAMESPACE@
ARMATURE_PLUGIN(@NAMESPACE@::@CLASS@);
