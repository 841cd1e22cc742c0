// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "video_device.hpp"

namespace armature::camera::v4l2 {

/// The kernel's own.
class KernelDevice final : public VideoDevice {
 public:
  ~KernelDevice() override { close(); }
  int open(const std::string& path) override;
  void close() override;
  int request(unsigned long number, void* argument) override;
  std::span<const std::uint8_t> map(std::size_t length, std::int64_t offset) override;
  Wake wait(int stop_descriptor, Duration timeout) override;
  Duration monotonic_now() const override;

 private:
  struct Mapping {
    void* start;
    std::size_t length;
  };
  int file_ = -1;
  std::vector<Mapping> mappings_;
};

}  // namespace armature::camera::v4l2
