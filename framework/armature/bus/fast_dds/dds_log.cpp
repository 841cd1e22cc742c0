// SPDX-License-Identifier: Apache-2.0
#include "armature/bus/fast_dds/dds_log.hpp"

#include <fastdds/dds/log/Log.hpp>
#include <memory>
#include <set>
#include <utility>

namespace armature {
namespace {

using eprosima::fastdds::dds::Log;

class ErrorsOnly final : public eprosima::fastdds::dds::LogConsumer {
 public:
  explicit ErrorsOnly(std::function<void(const std::string&)> on_error)
      : on_error_{std::move(on_error)} {}

  void Consume(const Log::Entry& entry) override {
    if (entry.kind != Log::Error || !on_error_) return;
    const std::string text =
        "Fast DDS: " + std::string{entry.context.category} + ": " + entry.message;
    constexpr std::size_t kMaxTexts = 100;
    if (seen_.size() < kMaxTexts && seen_.insert(text).second) on_error_(text);
  }

 private:
  std::function<void(const std::string&)> on_error_;
  std::set<std::string> seen_;
};

}  // namespace

DdsLog::DdsLog(std::function<void(const std::string&)> on_error) {
  Log::ClearConsumers();
  Log::SetVerbosity(Log::Error);
  Log::RegisterConsumer(std::make_unique<ErrorsOnly>(std::move(on_error)));
}

DdsLog::~DdsLog() {
  Log::ClearConsumers();  // waits for the entry that is being consumed
  Log::KillThread();
}

}  // namespace armature
