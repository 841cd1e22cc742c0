// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <iterator>
#include <list>
#include <string>
#include <utility>

#include "armature/web/web_server.hpp"

namespace armature {

/// A message for one client.
struct Outgoing {
  bool binary = false;
  bool may_drop = false;
  std::string text;  // or a binary message that is not shared
  std::array<std::byte, 16> head{};
  std::size_t head_size = 0;
  WebServer::Body body;

  std::size_t size() const { return text.size() + head_size + (body ? body->size() : 0); }
  /// With what it takes to keep it.
  std::size_t room() const { return size() + sizeof(Outgoing); }
};

/// What waits for a client to read it.
class OutgoingQueue {
 public:
  OutgoingQueue() = default;
  OutgoingQueue(const OutgoingQueue&) = delete;
  OutgoingQueue& operator=(const OutgoingQueue&) = delete;

  bool empty() const { return messages_.empty(); }
  std::size_t bytes() const { return bytes_; }
  /// Whether there are messages that may not be dropped.
  bool has_lasting() const { return messages_.size() > droppable_.size(); }

  void put(Outgoing message) {
    bytes_ += message.room();
    messages_.push_back(std::move(message));
    if (messages_.back().may_drop) droppable_.push_back(std::prev(messages_.end()));
  }
  Outgoing take() {
    Outgoing message = std::move(messages_.front());
    bytes_ -= message.room();
    if (message.may_drop) droppable_.pop_front();
    messages_.pop_front();
    return message;
  }
  /// False: none may be dropped.
  bool drop_oldest() {
    if (droppable_.empty()) return false;
    bytes_ -= droppable_.front()->room();
    messages_.erase(droppable_.front());
    droppable_.pop_front();
    return true;
  }
  void clear() {
    droppable_.clear();
    messages_.clear();
    bytes_ = 0;
  }

 private:
  std::list<Outgoing> messages_;
  std::deque<std::list<Outgoing>::iterator> droppable_;  // of them, in their order
  std::size_t bytes_ = 0;
};

}  // namespace armature
