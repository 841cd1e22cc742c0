// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <linux/videodev2.h>
#include <poll.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "video_device.hpp"

namespace armature::camera::v4l2 {

/// A camera for tests that does what a script says, and holds its user to the rules of the kernel:
/// what is asked when it is closed, and buffers that are given back twice, are failures.
class FakeCamera final : public VideoDevice {
 public:
  /// One thing that happens after the camera was started.
  struct Event {
    std::vector<std::uint8_t> bytes;
    Duration at{0};        // by the monotonic clock
    int error = 0;         // instead of a picture
    bool silence = false;  // instead of a picture: nobody hears anything until a timeout
    std::uint32_t flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
    std::uint32_t skipped = 0;  // pictures that the kernel drops before it
  };

  // What it is.
  std::uint32_t capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  std::vector<std::uint32_t> formats{V4L2_PIX_FMT_GREY};
  std::vector<std::pair<std::uint32_t, std::uint32_t>> sizes{{4, 2}};  // the first where none fits
  std::uint32_t padding = 0;                                           // bytes behind each row
  double rate = 0;                                                     // 0: it cannot be set
  std::map<std::uint32_t, double> rates;                               // of single formats
  std::map<std::uint32_t, std::pair<int, int>> controls;               // id: from, to
  std::deque<int> open_errors;                                         // of the next openings
  int start_error = 0;
  std::deque<Event> events;
  mutable Duration monotonic{0};
  mutable std::deque<Duration> suspensions;  // of its user, before the clock is asked, in turn

  // What was done to it.
  std::map<std::uint32_t, int> set;  // controls
  int openings = 0, starts = 0;
  std::vector<Duration> timeouts;    // of each wait
  std::atomic<bool> is_idle{false};  // all events have happened, and somebody waits for more
  bool is_open = false;

  int open(const std::string&) override {
    ++openings;
    if (!open_errors.empty()) {
      const int error = open_errors.front();
      open_errors.pop_front();
      if (error != 0) return error;
    }
    is_open = true;
    return 0;
  }
  void close() override {
    EXPECT_FALSE(runs_) << "closed while it runs";
    is_open = false;
    buffers_.clear();
    queued_.clear();
  }
  std::span<const std::uint8_t> map(std::size_t length, std::int64_t offset) override {
    EXPECT_TRUE(is_open);
    auto& buffer = buffers_.at(static_cast<std::size_t>(offset));
    buffer.resize(length);
    return buffer;
  }
  Wake wait(int stop_descriptor, Duration timeout) override {
    timeouts.push_back(timeout);
    if (!events.empty() && events.front().silence) {
      events.pop_front();
      return Wake::timeout;
    }
    if (!events.empty()) return Wake::frame;
    is_idle = true;
    pollfd stop{.fd = stop_descriptor, .events = POLLIN, .revents = 0};
    poll(&stop, 1, -1);
    return Wake::stop;
  }
  Duration monotonic_now() const override {
    if (!suspensions.empty()) {
      monotonic += suspensions.front();
      suspensions.pop_front();
    }
    return monotonic;
  }

  int request(unsigned long number, void* argument) override {
    EXPECT_TRUE(is_open);
    switch (number) {
      case VIDIOC_QUERYCAP: return tell(*static_cast<v4l2_capability*>(argument));
      case VIDIOC_ENUM_FMT: return tell(*static_cast<v4l2_fmtdesc*>(argument));
      case VIDIOC_ENUM_FRAMESIZES: return tell(*static_cast<v4l2_frmsizeenum*>(argument));
      case VIDIOC_S_FMT: return take(static_cast<v4l2_format*>(argument)->fmt.pix);
      case VIDIOC_S_PARM: return take(static_cast<v4l2_streamparm*>(argument)->parm.capture);
      case VIDIOC_QUERYCTRL: return tell(*static_cast<v4l2_queryctrl*>(argument));
      case VIDIOC_S_CTRL: return take(*static_cast<v4l2_control*>(argument));
      case VIDIOC_REQBUFS:
        buffers_.resize(static_cast<v4l2_requestbuffers*>(argument)->count);
        return 0;
      case VIDIOC_QUERYBUF: return tell(*static_cast<v4l2_buffer*>(argument));
      case VIDIOC_QBUF: return queue(*static_cast<v4l2_buffer*>(argument));
      case VIDIOC_DQBUF: return dequeue(*static_cast<v4l2_buffer*>(argument));
      case VIDIOC_STREAMON:
        ++starts;
        runs_ = start_error == 0;
        sequence_ = 0;
        return start_error;
      case VIDIOC_STREAMOFF: runs_ = false; return 0;
      default: ADD_FAILURE() << "the camera knows no request " << number; return ENOTTY;
    }
  }
  std::size_t queued() const { return queued_.size(); }

 private:
  int tell(v4l2_capability& found) const {
    std::copy_n("Fake", 5, found.card);
    found.capabilities = capabilities | V4L2_CAP_DEVICE_CAPS;
    found.device_caps = capabilities;
    return 0;
  }
  int tell(v4l2_fmtdesc& format) const {
    if (format.index >= formats.size()) return EINVAL;
    format.pixelformat = formats[format.index];
    return 0;
  }
  int tell(v4l2_frmsizeenum& size) const {
    if (size.index >= sizes.size()) return EINVAL;
    size.type = V4L2_FRMSIZE_TYPE_DISCRETE;
    size.discrete.width = sizes[size.index].first;
    size.discrete.height = sizes[size.index].second;
    return 0;
  }
  int take(v4l2_pix_format& format) {
    if (std::ranges::find(sizes, std::pair{format.width, format.height}) == sizes.end()) {
      format.width = sizes.front().first;
      format.height = sizes.front().second;
    }
    pixel_format_ = format.pixelformat;
    const bool two =
        format.pixelformat == V4L2_PIX_FMT_YUYV || format.pixelformat == V4L2_PIX_FMT_UYVY;
    format.bytesperline = format.width * (two ? 2 : 1) + padding;
    size_image_ = 2 * format.bytesperline * format.height + 4096;
    return 0;
  }
  int take(v4l2_captureparm& parameters) const {
    const auto own = rates.find(pixel_format_);
    const double told = own == rates.end() ? rate : own->second;
    if (told == 0) return ENOTTY;
    parameters.capability = V4L2_CAP_TIMEPERFRAME;
    parameters.timeperframe = {10, static_cast<std::uint32_t>(10 * told)};
    return 0;
  }
  int tell(v4l2_queryctrl& range) const {
    const auto found = controls.find(range.id);
    if (found == controls.end()) return EINVAL;
    range.minimum = found->second.first;
    range.maximum = found->second.second;
    return 0;
  }
  int take(const v4l2_control& control) {
    const auto found = controls.find(control.id);
    if (found == controls.end()) return EINVAL;
    if (control.value < found->second.first || control.value > found->second.second) return ERANGE;
    set[control.id] = control.value;
    return 0;
  }
  int tell(v4l2_buffer& buffer) const {
    buffer.length = size_image_;
    buffer.m.offset = buffer.index;
    return 0;
  }
  int queue(const v4l2_buffer& buffer) {
    EXPECT_EQ(std::ranges::find(queued_, buffer.index), queued_.end()) << "given back twice";
    EXPECT_LT(buffer.index, buffers_.size());
    queued_.push_back(buffer.index);
    return 0;
  }
  int dequeue(v4l2_buffer& buffer) {
    EXPECT_TRUE(runs_);
    if (events.empty()) return EAGAIN;
    const Event event = std::move(events.front());
    events.pop_front();
    if (event.error != 0) return event.error;
    EXPECT_FALSE(queued_.empty()) << "the camera has no buffer";
    buffer.index = queued_.front();
    queued_.pop_front();
    auto& bytes = buffers_.at(buffer.index);
    std::copy_n(event.bytes.begin(), std::min(event.bytes.size(), bytes.size()), bytes.begin());
    buffer.bytesused = static_cast<std::uint32_t>(event.bytes.size());
    buffer.flags = event.flags;
    sequence_ += event.skipped;
    buffer.sequence = sequence_++;
    buffer.timestamp.tv_sec = event.at.count() / 1'000'000'000;
    buffer.timestamp.tv_usec = event.at.count() % 1'000'000'000 / 1000;
    return 0;
  }

  bool runs_ = false;
  std::uint32_t size_image_ = 0, sequence_ = 0, pixel_format_ = 0;
  std::vector<std::vector<std::uint8_t>> buffers_;
  std::deque<std::uint32_t> queued_;
};

}  // namespace armature::camera::v4l2
