// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "armature/messages/type_description.hpp"

namespace armature ARMATURE_EXPORT {

/// A folder of IDL files, and the folder that the headers made of them are included from.
struct IdlFolder {
  std::filesystem::path folder;
  std::string header_folder;  // "armature/messages"
};

/// One IDL file, read and understood.
struct IdlFile {
  std::filesystem::path path;
  std::string header;  // "armature/messages/std_msgs.hpp"
  std::string text;
  std::vector<std::string> includes;          // headers of the files that it includes
  std::vector<const TypeDescription*> types;  // its own ones, in order
  std::vector<ConstantDescription> constants;
};

/// IDL files and what they include, each after those that it needs.
class IdlFiles {
 public:
  /// An included file is looked for beside the one that includes it, then in `folders`.
  IdlFiles(std::string header_folder, std::vector<IdlFolder> folders)
      : header_folder_{std::move(header_folder)}, folders_{std::move(folders)} {}

  /// Reads `path` if it was not read yet. The reason names file and line.
  Expected<void> read(const std::filesystem::path& path);
  /// In an order in which they can be understood.
  const std::vector<IdlFile>& all() const { return files_; }

 private:
  Expected<void> read(const std::filesystem::path& path, const std::string& header_folder);
  /// Reads an included file. Its header.
  Expected<std::string> include(const std::string& name, const IdlFolder& beside);
  bool was_read(const std::filesystem::path& path) const;

  std::string header_folder_;
  std::vector<IdlFolder> folders_;
  TypeDescriptions known_;
  std::vector<std::filesystem::path> begun_;
  std::vector<IdlFile> files_;
};

/// The header with a class for each struct of `file`. Each is also known as `alias::Name`; without
/// an alias, as ROS 2 calls it: `package::msg::Name`.
std::string message_header(const IdlFile& file, const std::string& alias);

/// The source of a library with the types of `files`: their MessageType, and their IDL as text.
std::string message_source(std::span<const IdlFile> files);

}  // namespace armature
