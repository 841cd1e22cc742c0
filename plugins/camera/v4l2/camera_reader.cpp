// SPDX-License-Identifier: Apache-2.0
#include "camera_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace armature::camera::v4l2 {
namespace {

constexpr Duration kOldest = seconds(10);
constexpr Duration kOneMoment = seconds(0.001);
constexpr int kMaxAttempts = 10;
constexpr int kMaxEmpty = 100;                 // wakes without a picture, one after the other
constexpr std::uint32_t kMaxLost = 1'000'000;  // more is a driver that counts otherwise

}  // namespace

void CameraReader::run(DriverQueue<Report>& reports) {
  VideoStream stream{*device_, settings_};
  while (!reports.stopping()) {
    std::string trouble;
    if (const auto opened = stream.open()) {
      last_sequence_.reset();
      reports.push(reports.now(), {.has_started = true});
      trouble = read_pictures(stream, reports);
      stream.close();  // a camera that was unplugged keeps its name until then
    } else {
      trouble = opened.error().text;
    }
    if (trouble.empty()) return;
    reports.push(reports.now(), {.trouble = std::move(trouble)});
    reports.sleep_for(timing_.try_again);
  }
}

std::string CameraReader::read_pictures(VideoStream& stream, DriverQueue<Report>& reports) {
  Duration timeout = std::max(timing_.first_within, timing_.timeout);
  for (int empty = 0; empty < kMaxEmpty;) {
    switch (device_->wait(reports.stop_descriptor(), timeout)) {
      case VideoDevice::Wake::stop: return {};
      case VideoDevice::Wake::timeout:
        return fmt::format("{}: no picture for {:g} s; the camera is started again",
                           settings_.device, to_seconds(timeout));
      case VideoDevice::Wake::frame: break;
    }
    const auto frame = stream.take();
    if (!frame) return frame.error().text;
    if (!*frame) {
      ++empty;
      continue;
    }
    empty = 0;
    timeout = timing_.timeout;
    const auto handed_over = hand_over(stream, **frame, reports);
    if (!handed_over) return handed_over.error().text;
  }
  return settings_.device +
         ": its driver tells of pictures and gives none; the camera is started again";
}

Expected<void> CameraReader::hand_over(VideoStream& stream, const VideoStream::Frame& frame,
                                       DriverQueue<Report>& reports) {
  const Time stamp = stamp_of(frame, reports);
  Report report;
  if (last_sequence_) {
    const std::uint32_t lost = frame.sequence - *last_sequence_ - 1;
    if (lost < kMaxLost) report.lost_before = lost;
  }
  last_sequence_ = frame.sequence;
  Expected<void> read = frame.is_damaged
                            ? refuse("a picture is damaged, as the camera's driver says")
                            : luma_of(stream.layout(), frame.bytes, settings_.width,
                                      settings_.height, stream.stride(), decoder_, report.pixels);
  const auto given_back = stream.give_back(frame);
  if (!read) {
    report.pixels.clear();
    report.was_bad = true;
    report.trouble = settings_.device + ": " + read.error().text;
  }
  reports.push(stamp, std::move(report));
  return given_back;
}

Time CameraReader::stamp_of(const VideoStream::Frame& frame,
                            const DriverQueue<Report>& reports) const {
  // Both clocks at one moment: a thread that is suspended between them asks again.
  Time now;
  Duration before, after = device_->monotonic_now();
  int attempts = 0;
  do {
    before = after;
    now = reports.now();
    after = device_->monotonic_now();
  } while (after - before > kOneMoment && ++attempts < kMaxAttempts);
  const Duration age = frame.at ? before - *frame.at : Duration{-1};
  const bool is_told = age >= Duration{0} && age <= kOldest;
  return now - (is_told ? age : Duration{0}) - timing_.delay;
}

}  // namespace armature::camera::v4l2
