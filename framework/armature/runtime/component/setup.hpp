// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "armature/bus/network.hpp"
#include "armature/config/node.hpp"
#include "armature/config/params.hpp"
#include "armature/runtime/component/driver_thread.hpp"
#include "armature/runtime/component/ports.hpp"
#include "armature/runtime/component/slot.hpp"
#include "armature/runtime/plugins/plugin_library.hpp"
#include "armature/runtime/plugins/plugin_manifest.hpp"
#include "armature/runtime/plugins/setup_error.hpp"
#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// What a component sees while it is being constructed; not valid afterwards. Not real-time safe.
class Setup {
 public:
  virtual ~Setup() = default;

  /// Name of the component in the deployment.
  virtual const std::string& name() const = 0;
  /// Which of the component's units this is: "main", or one that plugin.yaml lists under `units:`.
  virtual std::string_view unit() const = 0;
  /// The component's own checked parameters.
  virtual const Params& params() const = 0;
  /// A number that differs between components and follows the deployment's `seed:`.
  virtual std::uint64_t seed() const = 0;
  /// The document of a section ("robots", "rigs") that is bound to this component; plugin.yaml
  /// must list the section under `uses:`.
  virtual const config::Node& document(std::string_view section) = 0;
  /// False when the deployment binds none, which it may when plugin.yaml lists it under `may_use:`.
  virtual bool has_document(std::string_view section) const = 0;
  /// Also activate it every `period`, counted from the start.
  virtual void activate_every(Duration period) = 0;
  /// On the simulated clock, what it publishes reaches its readers so much later.
  virtual void deliver_after(Duration latency) = 0;
  /// Whether a component of the deployment writes the topic of this input.
  virtual bool is_written(std::string_view input) const = 0;
  /// How the run joins DDS, for a component that joins a domain by itself or listens on the
  /// network. Nothing when the component is constructed and not run: by `armature check`, by a
  /// replay, on a test bench. What is only there for a run (a port) is left alone then.
  virtual std::optional<NetworkOptions> network() const = 0;
  /// The time that the end of a run gives to what moves to come to rest: `run: {stop_within_s}`.
  virtual Duration stop_within() const = 0;
  /// Whether a plugin sits in slot `slot_name`. Always, unless the slot is optional.
  virtual bool is_filled(std::string_view slot_name) const = 0;
  /// What the plugin in slot `slot_name` says of itself.
  virtual const PluginManifest& slot_manifest(std::string_view slot_name) const = 0;

  template <class Message>
  Input<Message> input(std::string_view port) {
    return Input<Message>{claim_input(port, message_type<Message>())};
  }
  /// An input to which only samples arrive for which `Heeds` is true, so that what means nothing
  /// cannot push out of a queue what does. `Heeds` is called on the writer's thread; real-time
  /// safe.
  template <class Message, bool (*Heeds)(const Message&)>
  Input<Message> input_if(std::string_view port) {
    InputPort& claimed = claim_input(port, message_type<Message>());
    detail::input_heeds(
        claimed, [](const void* message) { return Heeds(*static_cast<const Message*>(message)); });
    return Input<Message>{claimed};
  }
  template <class Message>
  Output<Message> output(std::string_view port) {
    return Output<Message>{claim_output(port, message_type<Message>())};
  }

  /// Slot `slot_name` and the plugin that sits in it, made with `args` (after which come its
  /// parameters), as is every plugin that takes its place. The slot keeps copies of `args`. Throws
  /// SlotError with the plugin's own reason when it refuses, or throws itself.
  template <class Kind, class... Args>
  Slot<Kind> slot(std::string_view slot_name, const Args&... args) {
    auto place = std::make_unique<SlotOf<Kind>>(
        slot_name, [args...](typename Kind::Factory factory, const Params& params) {
          return factory(args..., params);
        });
    place->fill(slot_plugin(slot_name, Kind::kKind));
    Slot<Kind> slot{*place};
    keep_slot(std::move(place));
    return slot;
  }

  /// The same of a slot that may be empty.
  template <class Kind, class... Args>
  std::optional<Slot<Kind>> optional_slot(std::string_view slot_name, const Args&... args) {
    if (!is_filled(slot_name)) return std::nullopt;
    return slot<Kind>(slot_name, args...);
  }

  /// A thread for a device whose calls wait, and the queue of at most `capacity` samples from it to
  /// `step`, which every sample activates. `body` runs on it once, from the beginning of the run:
  /// `while (!queue.stopping()) queue.push(queue.now(), device.read());`. It has returned before
  /// the component is asked for its figures or destroyed. The plugin says `pure: false`, so that
  /// the simulated clock, which waits for nobody, refuses it by name.
  template <class Sample>
  DriverQueue<Sample>& driver_thread(std::size_t capacity, std::function<void()> body) {
    auto queue = std::make_unique<DriverQueue<Sample>>(capacity, std::move(body));
    DriverQueue<Sample>& kept = *queue;
    keep_thread(std::move(queue));
    return kept;
  }

  virtual std::shared_ptr<class StatusReporter> reporter() = 0;

 protected:
  virtual InputPort& claim_input(std::string_view port, const MessageType& type) = 0;
  virtual OutputPort& claim_output(std::string_view port, const MessageType& type) = 0;
  virtual SlotPlugin slot_plugin(std::string_view slot, std::string_view kind) = 0;
  virtual void keep_slot(std::unique_ptr<SlotPlace> place) = 0;
  virtual void keep_thread(std::unique_ptr<DriverThread> thread) = 0;
};

}  // namespace armature
