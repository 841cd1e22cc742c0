// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "armature/bus/fast_dds/fast_dds_transport.hpp"
#include "armature/bus/sample.hpp"

namespace armature::test {

inline Time system_now() {
  return Time{
      std::chrono::duration_cast<Duration>(std::chrono::system_clock::now().time_since_epoch())
          .count()};
}

/// A program that asks one solver: another deployment, or none at all, as far as it is concerned.
template <class Request, class Response>
class Asker {
 public:
  /// Asks on `topic`/request and hears on `topic`/response.
  Asker(Transport& transport, const std::string& topic)
      : requests_{message_type<Request>(), 4},
        writer_{std::move(*transport.advertise(
            {"rt" + topic + "/request", &message_type<Request>(), QosProfile::state}))},
        reader_{std::move(*transport.subscribe(
            {"rt" + topic + "/response", &message_type<Response>(), QosProfile::reply}, false,
            [this](const SampleRef& sample) { keep(sample); }))} {}

  bool connected(std::chrono::seconds timeout) const {
    for (const auto end = std::chrono::steady_clock::now() + timeout;
         std::chrono::steady_clock::now() < end;) {
      if (writer_->matched_readers() > 0 && reader_->writers() > 0) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds{20});
    }
    return false;
  }

  /// nullopt: no answer came within 20 s.
  std::optional<Response> ask(const Request& request) {
    SampleRef sample = requests_.loan();
    *static_cast<Request*>(sample.mutable_message()) = request;
    sample.mutable_info().published = system_now();
    std::unique_lock lock{mutex_};
    response_.reset();
    writer_->offer(sample);
    answered_.wait_for(lock, std::chrono::seconds{20}, [&] { return response_.has_value(); });
    return std::exchange(response_, std::nullopt);
  }

 private:
  void keep(const SampleRef& sample) {
    const std::scoped_lock lock{mutex_};
    response_ = *static_cast<const Response*>(sample.message());
    answered_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable answered_;
  std::optional<Response> response_;
  SamplePool requests_;  // outlives the writer, which may still be sending
  std::unique_ptr<RemoteWriter> writer_;
  std::unique_ptr<RemoteReader> reader_;
};

}  // namespace armature::test
