#include <algorithm>
#include <vector>

#include "@TARGET@_parameters.hpp"  // made from plugin.yaml
#include "@TARGET@_ports.hpp"
#include "armature/messages/header.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"

namespace @NAMESPACE@ {
using Picture = std::vector<std::uint8_t>;  // mono8, row by row

class @CLASS@ final : public Component {
 public:
  explicit @CLASS@(Setup& setup)
      : Component{setup},
        parameters_{Parameters::read(setup.params())},
        ports_{setup},
        pictures_{setup.driver_thread<Picture>(kWaiting, [this] { read(); })} {}

  /// Once for every picture, or for several that came together. Must not wait.
  void step(Time now) override {
    while (auto picture = pictures_.take()) {
      if (published_++ == 0) publish_info(picture->stamp);
      auto image = ports_.image.loan();
      write_header(image->header_(), picture->stamp, parameters_.frame);
      image->width_() = image->step_() = static_cast<std::uint32_t>(parameters_.width);
      image->height_() = static_cast<std::uint32_t>(parameters_.height);
      image->encoding_() = "mono8";
      image->data_() = std::move(picture->sample);
      image.publish();
      greatest_age_ = std::max(greatest_age_, now - picture->stamp);
    }
  }
  bool finished() const override {
    return parameters_.pictures > 0 && published_ >= parameters_.pictures;
  }
  void summarize(Summary& summary) const override {
    summary.metric("pictures", "pictures", static_cast<double>(published_));
    summary.metric("pictures_lost", "pictures lost", static_cast<double>(pictures_.dropped()));
    summary.metric("greatest_age_ms", "oldest picture when it was published [ms]",
                   1e3 * to_seconds(greatest_age_));
  }

 private:
  static constexpr std::size_t kWaiting =
      8;  // pictures that `step` has not taken yet; then the oldest is lost

  /// On a thread of its own, which may wait for the camera. Open it here, and not in the
  /// constructor: `armature check` makes the component, and opens no device. Return soon after
  /// `stopping()`.
  void read() {
    while (!pictures_.stopping()) {
      Picture picture = next_picture();
      pictures_.push(pictures_.now() - seconds(parameters_.delay), std::move(picture));
    }
  }

  /// Put your camera here: wait for its next picture, at most a second.
  Picture next_picture() {
    pictures_.sleep_for(seconds(1 / parameters_.rate));
    Picture picture(static_cast<std::size_t>(parameters_.width * parameters_.height), 40);
    std::fill_n(picture.begin() + parameters_.width * (row_++ % parameters_.height),
                parameters_.width, 220);
    return picture;
  }

  void publish_info(Time stamp) {
    const double f = parameters_.focal, cx = 0.5 * (parameters_.width - 1),
                 cy = 0.5 * (parameters_.height - 1);
    msg::CameraInfo info;
    write_header(info.header_(), stamp, parameters_.frame);
    info.width_() = static_cast<std::uint32_t>(parameters_.width);
    info.height_() = static_cast<std::uint32_t>(parameters_.height);
    info.distortion_model_() = "plumb_bob";
    info.d_().assign(5, 0.0);
    info.k_() = {f, 0, cx, 0, f, cy, 0, 0, 1};
    info.r_() = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    info.p_() = {f, 0, cx, 0, 0, f, cy, 0, 0, 0, 1, 0};
    ports_.info.publish(info);
  }

  Parameters parameters_;
  Ports ports_;
  DriverQueue<Picture>& pictures_;
  int row_ = 0;  // of the driver thread
  std::int64_t published_ = 0;
  Duration greatest_age_{0};
};
}  // namespace @NAMESPACE@
ARMATURE_PLUGIN(@NAMESPACE@::@CLASS@);
