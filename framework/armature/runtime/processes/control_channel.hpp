// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace armature ARMATURE_EXPORT {

/// One end of the way by which the main process of a deployment and another one talk: lines of text
/// in both directions, each whole. Nothing waits.
class ControlChannel {
 public:
  virtual ~ControlChannel() = default;
  virtual void send(std::string_view line) = 0;
  /// The next line, if there is one.
  virtual std::optional<std::string> receive() = 0;
  /// True once the other end is gone and every line of it has been received.
  virtual bool lost() const = 0;
};

/// Between processes of one machine. An end that is closed tells the other one, also when its
/// process was killed.
class SocketChannel final : public ControlChannel {
 public:
  /// An end that was inherited, by its number. -1: none; what is sent there goes nowhere.
  explicit SocketChannel(int file = -1);
  SocketChannel(SocketChannel&& other) noexcept
      : file_{std::exchange(other.file_, -1)}, lost_{other.lost_} {}
  SocketChannel& operator=(SocketChannel&&) = delete;
  ~SocketChannel() override;

  /// Two ends; neither is inherited by a program that is started unless it is handed over. Throws
  /// std::system_error.
  static std::pair<SocketChannel, SocketChannel> make();

  int file() const { return file_; }
  /// A line of which the other end has no room for is lost; so is the end of one that is longer
  /// than 4,000 bytes.
  void send(std::string_view line) override;
  std::optional<std::string> receive() override;
  bool lost() const override { return lost_; }

 private:
  int file_;
  bool lost_ = false;
};

}  // namespace armature
