// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "armature/runtime/plugins/plugin.hpp"
#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {

/// A loaded plugin library; unloaded when the last holder is gone. Or a plugin that is part of this
/// program, which stays.
class PluginLibrary {
 public:
  /// Loads `file` after its ABI tag was compared with ours; checks the kind of its
  /// entry. The reason carries both tags, or the text of dlerror.
  static Expected<std::shared_ptr<PluginLibrary>> load(const std::filesystem::path& file,
                                                       std::string_view kind);
  /// The same for a class of this program.
  static Expected<std::shared_ptr<PluginLibrary>> of_this_program(const PluginEntry& entry,
                                                                  std::string_view kind);
  ~PluginLibrary();
  PluginLibrary(const PluginLibrary&) = delete;
  PluginLibrary& operator=(const PluginLibrary&) = delete;

  const std::filesystem::path& file() const { return file_; }
  /// The factory of the plugin's class; cast it to Kind::Factory.
  void (*factory() const)() { return entry_.factory; }

 private:
  PluginLibrary(std::filesystem::path file, void* handle, const PluginEntry& entry)
      : file_{std::move(file)}, handle_{handle}, entry_{entry} {}

  std::filesystem::path file_;
  void* handle_;  // nullptr: this program
  PluginEntry entry_;
};

/// An object made by a plugin, and the library that its code lives in: the library stays loaded
/// until the object is gone.
template <class Kind>
class PluginPtr {
 public:
  PluginPtr() = default;
  PluginPtr(std::shared_ptr<PluginLibrary> library, std::unique_ptr<Kind> object)
      : library_{std::move(library)}, object_{std::move(object)} {}
  PluginPtr(PluginPtr&&) noexcept = default;
  PluginPtr& operator=(PluginPtr&& other) noexcept {
    object_ = std::move(other.object_);  // before its library goes
    library_ = std::move(other.library_);
    return *this;
  }

  Kind* operator->() const { return object_.get(); }
  Kind& operator*() const { return *object_; }
  explicit operator bool() const { return object_ != nullptr; }

 private:
  std::shared_ptr<PluginLibrary> library_;  // destroyed after the object
  std::unique_ptr<Kind> object_;
};

}  // namespace armature
