// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <concepts>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "armature/config/params.hpp"
#include "armature/runtime/plugins/plugin_library.hpp"
#include "armature/runtime/plugins/plugin_manifest.hpp"
#include "armature/runtime/plugins/setup_error.hpp"
#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {

/// A plugin for a slot: its library, what it says of itself and its checked parameters.
struct SlotPlugin {
  std::shared_ptr<PluginLibrary> library;
  PluginManifest manifest;
  Params params;
};

/// A slot as the runtime keeps it, whatever its kind. The runtime owns the plugin's object; the
/// component holds a `Slot` and never sees which object is behind it. An exchange has three steps:
/// `offer` makes the successor, `exchange` puts it in between two activations, `settle` frees the
/// object that sat there before. Its library stays as long as the slot: the label of a branch or
/// the reason of a refusal is text in there, and may be kept past an exchange.
class SlotPlace {
 public:
  /// Why a plugin must not sit here, or "".
  using Objection = std::function<std::string(const PluginManifest&)>;

  explicit SlotPlace(std::string_view name) : name_{name} {}
  virtual ~SlotPlace() = default;
  SlotPlace(const SlotPlace&) = delete;
  SlotPlace& operator=(const SlotPlace&) = delete;

  const std::string& name() const { return name_; }
  /// Of the plugin that sits here; of the component's own thread. The reference is good until
  /// the next exchange.
  virtual const PluginManifest& manifest() const = 0;
  /// What every successor is asked for. Before the first `offer`.
  void object_to(Objection objection) { objection_ = std::move(objection); }

  /// Makes the first plugin. Throws SlotError with the plugin's own refusal or what it threw, or
  /// the ConfigError of its parameters.
  virtual void fill(SlotPlugin plugin) = 0;

  /// Makes an object of `plugin`, which takes its place at the component's next activation; a
  /// successor that was offered before and still waits is dropped. The reason is the component's
  /// objection, or what `fill` would throw; then nothing changes. Not real-time safe; one caller
  /// at a time, on any thread but the component's.
  Expected<void> offer(SlotPlugin plugin) {
    if (objection_) {
      if (const std::string why = objection_(plugin.manifest); !why.empty()) return refuse(why);
    }
    try {
      await(std::move(plugin));
      return {};
    } catch (const std::exception& error) {
      return refuse(error.what());
    }
  }
  /// Puts in the successor, if one waits. Between two activations, on the component's thread;
  /// real-time safe.
  virtual void exchange() = 0;
  /// Frees the predecessor; true when no successor waits any more. The thread of `offer`.
  virtual bool settle() = 0;

 protected:
  virtual void await(SlotPlugin plugin) = 0;
  void keep(const std::shared_ptr<PluginLibrary>& library) {
    if (std::ranges::find(libraries_, library) == libraries_.end()) libraries_.push_back(library);
  }

 private:
  std::string name_;
  Objection objection_;
  std::vector<std::shared_ptr<PluginLibrary>> libraries_;  // of all plugins that have sat here
};

/// A slot of kind `Kind`, and how its plugins are made.
template <class Kind>
class SlotOf final : public SlotPlace {
 public:
  using Make =
      std::function<Expected<std::unique_ptr<Kind>>(typename Kind::Factory, const Params&)>;

  SlotOf(std::string_view name, Make make) : SlotPlace{name}, make_{std::move(make)} {}
  ~SlotOf() override {
    delete waiting_.load();
    delete leaving_.load();
  }

  /// Of the component's thread.
  Kind& plugin() const { return *occupant_->object; }
  const PluginManifest& manifest() const override { return occupant_->plugin.manifest; }

  void fill(SlotPlugin plugin) override { occupant_ = make(std::move(plugin)); }

  void exchange() override {
    if (!waiting_.load(std::memory_order_relaxed)) return;
    // The predecessor's predecessor is still to be freed: `settle` comes first.
    if (leaving_.load(std::memory_order_acquire)) return;
    Occupant* next = waiting_.exchange(nullptr, std::memory_order_acq_rel);
    if (!next) return;
    leaving_.store(occupant_.release(), std::memory_order_release);
    occupant_.reset(next);
  }

  bool settle() override {
    delete leaving_.exchange(nullptr, std::memory_order_acq_rel);
    return !waiting_.load(std::memory_order_acquire);
  }

 protected:
  void await(SlotPlugin plugin) override {
    delete waiting_.exchange(make(std::move(plugin)).release(), std::memory_order_acq_rel);
  }

 private:
  struct Occupant {
    SlotPlugin plugin;
    std::unique_ptr<Kind> object;  // goes before the library that its code lives in
  };

  std::unique_ptr<Occupant> make(SlotPlugin plugin) {
    auto next = std::make_unique<Occupant>(Occupant{std::move(plugin), nullptr});
    const std::string& id = next->plugin.manifest.id;
    // While `next` holds the library: an exception of the plugin's own type ends in here.
    auto made = [&] {
      try {
        return make_(reinterpret_cast<typename Kind::Factory>(next->plugin.library->factory()),
                     next->plugin.params);
      } catch (...) {
        throw_as_own(id, name());
      }
    }();
    if (!made) throw SlotError{name(), id + " refuses: " + made.error().text};
    next->object = std::move(*made);
    keep(next->plugin.library);
    return next;
  }

  Make make_;
  std::unique_ptr<Occupant> occupant_;
  std::atomic<Occupant*> waiting_{nullptr}, leaving_{nullptr};
};

/// What a component holds of a slot: a handle, copied as a value, good as long as the component. It
/// leads to the plugin that sits there now, so nobody keeps the plugin's address from one
/// activation to the next. Real-time safe. `Plugin` is the kind, or `const` the kind.
template <class Plugin>
class Slot {
  using Kind = std::remove_const_t<Plugin>;

 public:
  /// No slot: false, and nothing else may be asked.
  Slot() = default;
  explicit Slot(SlotOf<Kind>& place) : place_{&place} {}
  /// A plugin that is never exchanged, and outlives this.
  Slot(Plugin& plugin) : fixed_{&plugin} {}
  template <class Other>
  requires(std::is_const_v<Plugin>&& std::same_as<Other, Kind>) Slot(const Slot<Other>& other)
      : place_{other.place_}, fixed_{other.fixed_} {}

  Plugin& operator*() const { return place_ ? place_->plugin() : *fixed_; }
  Plugin* operator->() const { return &**this; }
  explicit operator bool() const { return place_ || fixed_; }

  /// What every successor is asked for. Only while the component is constructed.
  void object_to(SlotPlace::Objection objection) { place_->object_to(std::move(objection)); }

 private:
  template <class Other>
  friend class Slot;

  SlotOf<Kind>* place_ = nullptr;
  Plugin* fixed_ = nullptr;
};

}  // namespace armature
