// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "armature/runtime/plugins/plugin_library.hpp"
#include "armature/runtime/plugins/plugin_manifest.hpp"
#include "armature/runtime/plugins/running_component.hpp"
#include "armature/runtime/plugins/setup_error.hpp"

namespace armature ARMATURE_EXPORT {

/// A plugin library is there but cannot be used.
class PluginError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The plugins of the search path, known by their manifests; libraries are loaded only when asked
/// for and shared by everybody who uses them.
class PluginRegistry {
 public:
  struct Unusable {
    std::filesystem::path file;
    std::string reason;
  };
  /// A library of message types (armature_add_messages) and their IDL.
  struct Messages {
    std::filesystem::path file;
    std::string idl;
  };

  /// $ARMATURE_PLUGIN_PATH (colon-separated), then the framework's own plugin folder.
  static std::vector<std::filesystem::path> default_search_path();
  /// Reads the manifests of every *.so in the folders, in order; the first of an id wins.
  explicit PluginRegistry(std::vector<std::filesystem::path> search_path = default_search_path());

  /// Adds class `Plugin` of this program under the manifest of `plugin_yaml`, before anything that
  /// was read with this registry refers to it. An id that is there already is not replaced: throws
  /// std::invalid_argument.
  template <class Plugin>
  void add(std::string_view plugin_yaml) {
    add(plugin_yaml, detail::plugin_entry<Plugin>());
  }

  const std::vector<std::filesystem::path>& search_path() const { return search_path_; }
  /// Sorted by id.
  const std::vector<PluginManifest>& plugins() const { return plugins_; }
  const std::vector<Unusable>& unusable() const { return unusable_; }
  /// Of the search path; none of them was loaded.
  const std::vector<Messages>& messages() const { return messages_; }
  /// What whoever runs these plugins must know: folders and files that others may write, and
  /// ids that are there twice, with both paths. One sentence each.
  const std::vector<std::string>& warnings() const { return warnings_; }

  /// The plugin, or nullptr.
  const PluginManifest* find(std::string_view id) const;
  /// The component that runs a pure kind alone on topics, or nullptr.
  const PluginManifest* host_of(std::string_view kind) const;
  /// "unknown plugin 'ik/geometric'; did you mean ...; searched: ..." with the reasons of
  /// libraries that might have been it.
  std::string unknown_text(std::string_view id) const;

  /// Loads (once) the library of `plugin`. Throws PluginError with file and reason.
  std::shared_ptr<PluginLibrary> load(const PluginManifest& plugin, std::string_view kind);

  /// Loads `id` and makes an object of it; throws PluginError when the library cannot be used, and
  /// hands on the plugin's own refusal, or what it throws, as a reason.
  template <class Kind, class... Args>
  Expected<PluginPtr<Kind>> make(std::string_view id, const Args&... args) {
    const PluginManifest* plugin = find(id);
    if (!plugin) return refuse(unknown_text(id));
    auto library = load(*plugin, Kind::kKind);
    auto factory = reinterpret_cast<typename Kind::Factory>(library->factory());
    const RunningComponent running{plugin->id, "constructor", "plugin"};
    // While the library is held: an exception of the plugin's own type ends in here.
    try {
      auto made = factory(args...);
      if (!made) return tl::unexpected{made.error()};
      return PluginPtr<Kind>{std::move(library), std::move(*made)};
    } catch (...) {
      return refuse(plugin->id + ": " + current_exception_text());
    }
  }

 private:
  void scan(const std::filesystem::path& folder);
  /// False when the folder's plugins must not be loaded; either way its danger is noted.
  bool may_load_from(const std::filesystem::path& folder);
  /// The same of one library, or of what a link leads to.
  bool may_load(const std::filesystem::path& file);
  void add(const std::filesystem::path& file);
  void add(std::string_view plugin_yaml, const PluginEntry& entry);
  void sort();

  std::vector<std::filesystem::path> search_path_;
  std::vector<PluginManifest> plugins_;
  std::vector<Unusable> unusable_;
  std::vector<Messages> messages_;
  std::vector<std::string> warnings_;
  std::map<std::string, PluginEntry, std::less<>> of_this_program_;
  std::map<std::string, std::weak_ptr<PluginLibrary>> loaded_;
};

}  // namespace armature
