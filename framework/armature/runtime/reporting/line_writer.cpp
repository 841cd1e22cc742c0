// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/reporting/line_writer.hpp"

#include <poll.h>
#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>
#include <utility>

namespace armature {

/// A ring of slots, each with the number of its next turn: D. Vyukov's bounded queue, of which one
/// thread takes. A thread that is interrupted while it fills a slot delays the writing, nobody
/// else.
struct LineWriter::Queue {
  struct Slot {
    std::atomic<std::uint64_t> turn{0};
    std::size_t size = 0;
    std::array<char, kMaxLine + 1> text{};
  };

  Queue(int to, std::function<std::string(std::uint64_t)> line)
      : file{to}, dropped_line{std::move(line)} {
    for (std::size_t i = 0; i < kCapacity; ++i) slots[i].turn = i;
  }

  int file;
  std::function<std::string(std::uint64_t)> dropped_line;
  std::array<Slot, kCapacity> slots;
  std::atomic<std::uint64_t> put{0}, written{0}, dropped{0};
  std::atomic<std::uint32_t> news{0};
  std::atomic<bool> closed{false}, ends{false};

  void wake() {
    news.fetch_add(1, std::memory_order_release);
    news.notify_one();
  }

  /// Writes all of `text`; waits as long as it takes. False: the file has no room for it now.
  bool write_out(std::string_view text) {
    while (!text.empty() && !closed) {
      const ssize_t n = ::write(file, text.data(), text.size());
      if (n > 0) text.remove_prefix(static_cast<std::size_t>(n));
      if (n >= 0 || errno == EINTR) continue;
      if (errno == EAGAIN) {
        pollfd writable{.fd = file, .events = POLLOUT, .revents = 0};
        poll(&writable, 1, -1);
        continue;
      }
      if (errno == ENOSPC || errno == EDQUOT || errno == EFBIG) return false;
      closed = true;
    }
    return true;
  }

  bool write_next() {
    const std::uint64_t turn = written.load(std::memory_order_relaxed);
    Slot& slot = slots[turn % kCapacity];
    if (slot.turn.load(std::memory_order_acquire) != turn + 1) return false;
    slot.text[slot.size] = '\n';
    if (!write_out({slot.text.data(), slot.size + 1})) ++dropped;
    slot.turn.store(turn + kCapacity, std::memory_order_release);
    written.store(turn + 1, std::memory_order_release);
    if (const auto lost = dropped.exchange(0); lost > 0 && !write_out(dropped_line(lost) + '\n')) {
      dropped += lost;
    }
    return true;
  }

  void run() {
    pthread_setname_np(pthread_self(), "lines");
    while (!ends) {
      const std::uint32_t seen = news.load(std::memory_order_acquire);
      if (!write_next()) news.wait(seen, std::memory_order_acquire);
    }
  }
};

LineWriter::LineWriter(int file, std::function<std::string(std::uint64_t)> dropped_line)
    : queue_{std::make_shared<Queue>(file, std::move(dropped_line))} {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);  // signals are for the program's own threads
  std::thread{[queue = queue_] { queue->run(); }}.detach();
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

LineWriter::~LineWriter() {
  queue_->ends = true;
  queue_->wake();
}

void LineWriter::put(std::string_view line) {
  std::uint64_t turn = queue_->put.load(std::memory_order_relaxed);
  Queue::Slot* slot = nullptr;
  for (;;) {
    slot = &queue_->slots[turn % kCapacity];
    const auto ahead = static_cast<std::int64_t>(slot->turn.load(std::memory_order_acquire) - turn);
    if (ahead < 0) {
      queue_->dropped.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    if (ahead > 0) {
      turn = queue_->put.load(std::memory_order_relaxed);
    } else if (queue_->put.compare_exchange_weak(turn, turn + 1, std::memory_order_relaxed)) {
      break;
    }
  }
  slot->size = std::min(line.size(), kMaxLine);
  std::memcpy(slot->text.data(), line.data(), slot->size);
  slot->turn.store(turn + 1, std::memory_order_release);
  queue_->wake();
}

void LineWriter::flush(Duration timeout) {
  const auto end = std::chrono::steady_clock::now() + timeout;
  while (!closed() && queue_->written != queue_->put && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds{1});
  }
}

bool LineWriter::closed() const { return queue_->closed; }

bool is_reader_gone(int file) {
  pollfd state{.fd = file, .events = 0, .revents = 0};
  return poll(&state, 1, 0) > 0 && (state.revents & (POLLERR | POLLHUP)) != 0;
}

}  // namespace armature
