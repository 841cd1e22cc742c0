// SPDX-License-Identifier: Apache-2.0
#include "video_stream.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>

namespace armature::camera::v4l2 {
namespace {

constexpr std::uint32_t kBuffers = 4;
constexpr std::uint32_t kMaxListed = 64;  // of what a camera offers
constexpr double kExposureStep = 1e-4;    // [s] V4L2_CID_EXPOSURE_ABSOLUTE
constexpr double kSameRate = 0.01;

struct Format {
  Layout layout;
  std::uint32_t pixel_format;
};
constexpr std::array<Format, 6> kFormats{{{Layout::grey, V4L2_PIX_FMT_GREY},
                                          {Layout::nv12, V4L2_PIX_FMT_NV12},
                                          {Layout::yuyv, V4L2_PIX_FMT_YUYV},
                                          {Layout::uyvy, V4L2_PIX_FMT_UYVY},
                                          {Layout::mjpeg, V4L2_PIX_FMT_MJPEG},
                                          {Layout::mjpeg, V4L2_PIX_FMT_JPEG}}};

std::string name_of(std::uint32_t pixel_format) {
  std::string name;
  for (int i = 0; i < 4; ++i) {
    const char c = static_cast<char>(pixel_format >> (8 * i));
    name += c >= ' ' && c <= '~' ? c : '?';
  }
  return name;
}

std::string text_of(int error) { return std::strerror(error); }

const char* hint(int error) {
  switch (error) {
    case ENOENT:
    case ENODEV:
    case ENXIO: return "; is it plugged in?";
    case EACCES: return "; its user must be in the group 'video'";
    case EBUSY: return "; another program has it";
    default: return "";
  }
}

}  // namespace

Expected<void> VideoStream::open() {
  close();
  if (const int error = device_.open(settings_.device)) {
    return refuse(
        fmt::format("cannot open {}: {}{}", settings_.device, text_of(error), hint(error)));
  }
  const auto opened = check_device()
                          .and_then([&] { return set_format_and_rate(); })
                          .and_then([&] { return set_exposure_and_gain(); })
                          .and_then([&] { return map_buffers(); });
  if (!opened) {
    close();
    return opened;
  }
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (const int error = device_.request(VIDIOC_STREAMON, &type)) {
    close();
    return refuse(fmt::format("{} does not start: {}{}", card_, text_of(error),
                              error == ENOSPC
                                  ? "; its USB bus has no room for more pictures: take another "
                                    "port, mjpeg, or fewer pictures"
                                  : hint(error)));
  }
  runs_ = true;
  return {};
}

void VideoStream::close() {
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (runs_) device_.request(VIDIOC_STREAMOFF, &type);
  runs_ = false;
  buffers_.clear();
  device_.close();
}

Expected<void> VideoStream::check_device() {
  v4l2_capability found{};
  if (const int error = device_.request(VIDIOC_QUERYCAP, &found)) {
    return refuse(fmt::format("{} is no camera: {}", settings_.device, text_of(error)));
  }
  const auto* card = reinterpret_cast<const char*>(found.card);
  card_ =
      fmt::format("{} ({})", settings_.device, std::string{card, strnlen(card, sizeof found.card)});
  const std::uint32_t can =
      found.capabilities & V4L2_CAP_DEVICE_CAPS ? found.device_caps : found.capabilities;
  if (!(can & V4L2_CAP_VIDEO_CAPTURE)) {
    return refuse(
        fmt::format("{} takes no pictures{}", card_,
                    can & V4L2_CAP_VIDEO_CAPTURE_MPLANE
                        ? " in one plane; those of several planes are not read"
                        : "; a camera often has several devices, of which the first is the one"));
  }
  if (!(can & V4L2_CAP_STREAMING)) return refuse(card_ + " has no streaming input and output");
  return {};
}

std::vector<std::uint32_t> VideoStream::offered_formats() {
  std::vector<std::uint32_t> offered;
  for (std::uint32_t i = 0; i < kMaxListed; ++i) {
    v4l2_fmtdesc format{};
    format.index = i;
    format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (device_.request(VIDIOC_ENUM_FMT, &format) != 0) break;
    offered.push_back(format.pixelformat);
  }
  return offered;
}

std::string VideoStream::offered_sizes(std::uint32_t pixel_format) {
  std::vector<std::string> sizes;
  for (std::uint32_t i = 0; i < kMaxListed; ++i) {
    v4l2_frmsizeenum size{};
    size.index = i;
    size.pixel_format = pixel_format;
    if (device_.request(VIDIOC_ENUM_FRAMESIZES, &size) != 0) break;
    if (size.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
      sizes.push_back(fmt::format("{} x {}", size.discrete.width, size.discrete.height));
    } else {
      sizes.push_back(fmt::format("{} x {} to {} x {}", size.stepwise.min_width,
                                  size.stepwise.min_height, size.stepwise.max_width,
                                  size.stepwise.max_height));
    }
  }
  return sizes.empty() ? "" : fmt::format("; it offers {}", fmt::join(sizes, ", "));
}

Expected<void> VideoStream::set_format_and_rate() {
  const std::vector<std::uint32_t> offered = offered_formats();
  std::optional<Expected<void>> first;  // of those that are refused
  for (const auto& [layout, pixel_format] : kFormats) {
    const bool is_asked_for = !settings_.layout || layout == *settings_.layout;
    if (!is_asked_for || std::ranges::find(offered, pixel_format) == offered.end()) continue;
    layout_ = layout;
    Expected<void> set = set_format(pixel_format).and_then([&] { return set_rate(); });
    if (set) return set;
    if (!first) first = std::move(set);
  }
  if (first) return *first;
  std::vector<std::string> names;
  std::ranges::transform(offered, std::back_inserter(names), name_of);
  return refuse(fmt::format("{} has not the format that is asked for; it offers {}", card_,
                            fmt::join(names, ", ")));
}

Expected<void> VideoStream::set_format(std::uint32_t pixel_format) {
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  format.fmt.pix.width = static_cast<std::uint32_t>(settings_.width);
  format.fmt.pix.height = static_cast<std::uint32_t>(settings_.height);
  format.fmt.pix.pixelformat = pixel_format;
  format.fmt.pix.field = V4L2_FIELD_NONE;
  if (const int error = device_.request(VIDIOC_S_FMT, &format)) {
    return refuse(fmt::format("{} takes no format: {}{}", card_, text_of(error), hint(error)));
  }
  const v4l2_pix_format& got = format.fmt.pix;
  if (got.pixelformat != pixel_format || got.width != static_cast<std::uint32_t>(settings_.width) ||
      got.height != static_cast<std::uint32_t>(settings_.height)) {
    return refuse(fmt::format("{} gives {} x {} pixels of {} instead of {} x {} of {}{}", card_,
                              got.width, got.height, name_of(got.pixelformat), settings_.width,
                              settings_.height, name_of(pixel_format),
                              offered_sizes(pixel_format)));
  }
  if (got.field != V4L2_FIELD_NONE && got.field != V4L2_FIELD_ANY) {
    return refuse(card_ + " gives interlaced pictures, which are not read");
  }
  const std::size_t row = static_cast<std::size_t>(settings_.width) *
                          (layout_ == Layout::yuyv || layout_ == Layout::uyvy ? 2 : 1);
  stride_ = std::max<std::size_t>(got.bytesperline, row);
  return {};
}

Expected<void> VideoStream::set_rate() {
  if (settings_.rate == 0) return {};
  constexpr std::uint32_t kUnit = 1000;
  v4l2_streamparm parameters{};
  parameters.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  parameters.parm.capture.timeperframe = {
      kUnit, static_cast<std::uint32_t>(std::lround(settings_.rate * kUnit))};
  const int error = device_.request(VIDIOC_S_PARM, &parameters);
  if (error != 0 || !(parameters.parm.capture.capability & V4L2_CAP_TIMEPERFRAME)) {
    return refuse(card_ + " has one rate only, which cannot be set; leave rate_hz out");
  }
  const v4l2_fract& time = parameters.parm.capture.timeperframe;
  const double rate = time.numerator == 0 ? 0 : double{1} * time.denominator / time.numerator;
  if (std::abs(rate - settings_.rate) > kSameRate * settings_.rate) {
    return refuse(
        fmt::format("{} takes {:g} pictures a second at {} x {} instead of {:g}; set rate_hz: {:g}",
                    card_, rate, settings_.width, settings_.height, settings_.rate, rate));
  }
  return {};
}

Expected<void> VideoStream::set_control(std::uint32_t id, std::int64_t value,
                                        const std::string& parameter) {
  v4l2_queryctrl range{};
  range.id = id;
  if (device_.request(VIDIOC_QUERYCTRL, &range) != 0 || (range.flags & V4L2_CTRL_FLAG_DISABLED)) {
    return refuse(fmt::format("{} lets nobody set it; leave {} out", card_, parameter));
  }
  if (value < range.minimum || value > range.maximum) {
    const double unit = id == V4L2_CID_EXPOSURE_ABSOLUTE ? 1e3 * kExposureStep : 1;
    return refuse(fmt::format("{} takes a {} from {:g} to {:g}, not {:g}", card_, parameter,
                              unit * range.minimum, unit * range.maximum,
                              unit * static_cast<double>(value)));
  }
  v4l2_control control{.id = id, .value = static_cast<std::int32_t>(value)};
  if (const int error = device_.request(VIDIOC_S_CTRL, &control)) {
    return refuse(fmt::format("{} does not take {}: {}", card_, parameter, text_of(error)));
  }
  return {};
}

Expected<void> VideoStream::set_exposure_and_gain() {
  if (settings_.exposure > 0) {
    const auto steps = std::max<std::int64_t>(1, std::lround(settings_.exposure / kExposureStep));
    const auto set =
        set_control(V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL, "exposure_ms").and_then([&] {
          return set_control(V4L2_CID_EXPOSURE_ABSOLUTE, steps, "exposure_ms");
        });
    if (!set) return set;
  } else {
    // What a program before this one has set must not stay; a camera without the control has none.
    for (const int automatic : {V4L2_EXPOSURE_APERTURE_PRIORITY, V4L2_EXPOSURE_AUTO}) {
      v4l2_control control{.id = V4L2_CID_EXPOSURE_AUTO, .value = automatic};
      if (device_.request(VIDIOC_S_CTRL, &control) == 0) break;
    }
  }
  if (!settings_.gain) return {};
  v4l2_control no_automatic{.id = V4L2_CID_AUTOGAIN, .value = 0};
  device_.request(VIDIOC_S_CTRL, &no_automatic);  // many cameras have none
  return set_control(V4L2_CID_GAIN, *settings_.gain, "gain");
}

Expected<void> VideoStream::map_buffers() {
  v4l2_requestbuffers wanted{};
  wanted.count = kBuffers;
  wanted.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  wanted.memory = V4L2_MEMORY_MMAP;
  if (const int error = device_.request(VIDIOC_REQBUFS, &wanted)) {
    return refuse(fmt::format("{} has no buffers: {}{}", card_, text_of(error), hint(error)));
  }
  for (std::uint32_t i = 0; i < wanted.count; ++i) {
    v4l2_buffer buffer{};
    buffer.index = i;
    buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    buffer.memory = V4L2_MEMORY_MMAP;
    int error = device_.request(VIDIOC_QUERYBUF, &buffer);
    if (error == 0) buffers_.push_back(device_.map(buffer.length, buffer.m.offset));
    if (error == 0 && buffers_.back().empty()) error = ENOMEM;
    if (error == 0) error = device_.request(VIDIOC_QBUF, &buffer);
    if (error != 0) {
      return refuse(fmt::format("buffer {} of {} cannot be used: {}", i, card_, text_of(error)));
    }
  }
  if (buffers_.size() < 2) return refuse(card_ + " has fewer than two buffers");
  return {};
}

Expected<std::optional<VideoStream::Frame>> VideoStream::take() {
  v4l2_buffer buffer{};
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  if (const int error = device_.request(VIDIOC_DQBUF, &buffer)) {
    if (error == EAGAIN) return std::optional<Frame>{};
    return refuse(
        fmt::format("{} gives no more pictures: {}{}", card_, text_of(error), hint(error)));
  }
  if (buffer.index >= buffers_.size()) return refuse(card_ + " tells of a buffer that it has not");
  const auto whole = buffers_[buffer.index];
  Frame frame{.bytes = whole.first(std::min<std::size_t>(buffer.bytesused, whole.size())),
              .is_damaged = (buffer.flags & V4L2_BUF_FLAG_ERROR) != 0,
              .at = {},
              .sequence = buffer.sequence,
              .buffer = buffer.index};
  if ((buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC) {
    frame.at = std::chrono::seconds{buffer.timestamp.tv_sec} +
               std::chrono::microseconds{buffer.timestamp.tv_usec};
  }
  return frame;
}

Expected<void> VideoStream::give_back(const Frame& frame) {
  v4l2_buffer buffer{};
  buffer.index = frame.buffer;
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  if (const int error = device_.request(VIDIOC_QBUF, &buffer)) {
    return refuse(fmt::format("{} takes no buffer back: {}{}", card_, text_of(error), hint(error)));
  }
  return {};
}

}  // namespace armature::camera::v4l2
