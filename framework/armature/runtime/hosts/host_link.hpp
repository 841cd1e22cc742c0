// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "armature/bus/topic.hpp"
#include "armature/bus/transport.hpp"
#include "armature/runtime/execution/clock.hpp"
#include "armature/runtime/hosts/clock_offset.hpp"
#include "armature/runtime/hosts/line_exchange.hpp"

namespace armature ARMATURE_EXPORT {

/// Which end of the way between the main process of a deployment and the agent of another host.
struct HostLinkEnd {
  std::string deployment, host;
  bool of_main = false;
  std::string id;  // one word that no other end has
};

/// The way between the main process of a deployment and the agent that runs its processes on
/// another host: lines to and from each process, and questions for the main process' clock. Both
/// ends tell ten times a second that they are there. Not for several threads.
class HostLink {
 public:
  /// Who is silent for longer is lost.
  static constexpr Duration kSilence = seconds(1);
  /// What the agent itself is called among its processes.
  static constexpr std::string_view kAgent = "*";

  /// Throws PluginError. `transport` and `clock` must outlive it.
  HostLink(Transport& transport, HostLinkEnd end, const Clock& clock);
  ~HostLink();
  HostLink(const HostLink&) = delete;
  HostLink& operator=(const HostLink&) = delete;

  const std::string& host() const { return end_.host; }
  /// The id of the other end; "" before they have met.
  const std::string& other() const { return lines_.other(); }
  bool lost() const;
  /// Whether another agent answers as this host, too.
  bool is_doubled() const { return lines_.is_asked_by_third(); }
  /// Forgets the other end, and waits for another one.
  void turn_away();

  void send(std::string_view process, std::string_view line);
  std::optional<std::string> receive(std::string_view process);
  /// True when the other end has got all that was sent.
  bool all_arrived() const { return lines_.waiting() == 0; }

  /// Takes what has come and tells what is to be told. To be called at least every 20 ms.
  void update();

  /// Of the agent: asks the main process for its time; answered a moment later, or never.
  void ask_clock();
  /// How far the main process' clock is ahead of `clock`.
  std::optional<ClockOffset::Estimate> clock_ahead() const;
  std::size_t clock_answers() const;

 private:
  class Inbox;

  HostLinkEnd end_;
  const Clock& clock_;
  LineExchange lines_;
  std::map<std::string, std::deque<std::string>, std::less<>> received_;  // by process
  bool to_be_told_ = true;
  Time told_;
  std::unique_ptr<Inbox> inbox_;
  std::unique_ptr<RemoteReader> reader_;  // goes first
};

}  // namespace armature
