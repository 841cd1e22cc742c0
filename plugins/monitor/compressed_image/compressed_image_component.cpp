// SPDX-License-Identifier: Apache-2.0
#include "armature/messages/sensor_msgs.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/execution/rate_limiter.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "jpeg_encoder.hpp"
#include "monitor_compressed_image_parameters.hpp"
#include "monitor_compressed_image_ports.hpp"

namespace armature::monitor::compressed_image {

/// A camera's pictures for viewers far away. Nobody in the deployment reads what it writes.
class CompressedImage final : public Component {
 public:
  explicit CompressedImage(Setup& setup)
      : CompressedImage{setup, Parameters::read(setup.params())} {}

  void step(Time now) override {
    if (!ports_.image.fresh() || !ports_.compressed.has_subscribers() || !rate_limiter_.due(now))
      return;
    const msg::Image& image = *ports_.image.latest();
    auto compressed = ports_.compressed.loan();
    if (const auto encoded = encoder_.encode(image, compressed->data_()); !encoded) {
      return degraded(encoded.error().text);
    }
    compressed->header_(image.header_());
    compressed->format_("jpeg");
    compressed.publish();
    healthy();
  }

 private:
  CompressedImage(Setup& setup, const Parameters& parameters)
      : Component{setup},
        encoder_{static_cast<int>(parameters.quality)},
        rate_limiter_{seconds(1 / parameters.rate)},
        ports_{setup} {}

  jpeg::JpegEncoder encoder_;
  RateLimiter rate_limiter_;
  Ports ports_;
};

}  // namespace armature::monitor::compressed_image

ARMATURE_PLUGIN(armature::monitor::compressed_image::CompressedImage);
