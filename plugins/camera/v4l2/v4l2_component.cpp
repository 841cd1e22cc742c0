// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "armature/messages/header.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "camera_reader.hpp"
#include "camera_v4l2_parameters.hpp"
#include "camera_v4l2_ports.hpp"
#include "kernel_device.hpp"

namespace armature::camera::v4l2 {
namespace {

constexpr std::size_t kWaiting = 8;        // reports that `step` has not taken yet
constexpr Duration kTellFor = seconds(1);  // of a picture that could not be used

std::optional<Layout> layout_of(Parameters::Format format) {
  switch (format) {
    case Parameters::Format::any: return std::nullopt;
    case Parameters::Format::grey: return Layout::grey;
    case Parameters::Format::nv12: return Layout::nv12;
    case Parameters::Format::yuyv: return Layout::yuyv;
    case Parameters::Format::uyvy: return Layout::uyvy;
    case Parameters::Format::mjpeg: return Layout::mjpeg;
  }
  return std::nullopt;
}

StreamSettings settings_of(const Parameters& parameters) {
  return {.device = parameters.device,
          .width = parameters.width,
          .height = parameters.height,
          .rate = parameters.rate,
          .layout = layout_of(parameters.format),
          .exposure = parameters.exposure,
          .gain = parameters.gain < 0 ? std::nullopt : std::optional<int>{parameters.gain}};
}

}  // namespace

/// A camera of the kernel.
class V4l2 final : public Component {
 public:
  explicit V4l2(Setup& setup)
      : Component{setup},
        parameters_{Parameters::read(setup.params())},
        ports_{setup},
        reader_{std::make_unique<KernelDevice>(),
                settings_of(parameters_),
                {.delay = seconds(parameters_.delay), .timeout = seconds(parameters_.timeout)}},
        reports_{setup.driver_thread<Report>(kWaiting, [this] { reader_.run(reports_); })} {}

  void step(Time now) override {
    while (auto report = reports_.take()) hear(report->stamp, std::move(report->sample), now);
  }
  void summarize(Summary& summary) const override;

 private:
  void hear(Time stamp, Report report, Time now);
  void publish(Time stamp, std::vector<std::uint8_t> pixels, Time now);

  Parameters parameters_;
  Ports ports_;
  CameraReader reader_;
  DriverQueue<Report>& reports_;
  std::uint64_t published_ = 0, bad_ = 0, lost_ = 0, starts_ = 0;
  std::optional<Time> bad_at_;
  Duration greatest_age_{0};
};

void V4l2::hear(Time stamp, Report report, Time now) {
  lost_ += report.lost_before;
  starts_ += report.has_started;
  bad_ += report.was_bad;
  if (report.was_bad) bad_at_ = now;
  if (!report.trouble.empty()) degraded(report.trouble);
  if (report.pixels.empty()) return;
  publish(stamp, std::move(report.pixels), now);
  if (!bad_at_ || now - *bad_at_ > kTellFor) healthy();
}

void V4l2::publish(Time stamp, std::vector<std::uint8_t> pixels, Time now) {
  auto image = ports_.image.loan();
  write_header(image->header_(), stamp, parameters_.frame);
  image->width_() = image->step_() = static_cast<std::uint32_t>(parameters_.width);
  image->height_() = static_cast<std::uint32_t>(parameters_.height);
  image->encoding_() = "mono8";
  image->is_bigendian_() = 0;
  image->data_() = std::move(pixels);
  image.publish();
  ++published_;
  greatest_age_ = std::max(greatest_age_, now - stamp);
}

void V4l2::summarize(Summary& summary) const {
  summary.metric("pictures", "pictures", static_cast<double>(published_));
  summary.metric("pictures_bad", "pictures that could not be used", static_cast<double>(bad_));
  summary.metric("pictures_lost", "pictures lost", static_cast<double>(lost_ + reports_.dropped()));
  summary.metric("camera_starts", "starts of the camera", static_cast<double>(starts_));
  summary.metric("greatest_age_ms", "oldest picture when it was published [ms]",
                 1e3 * to_seconds(greatest_age_));
}

}  // namespace armature::camera::v4l2

ARMATURE_PLUGIN(armature::camera::v4l2::V4l2);
