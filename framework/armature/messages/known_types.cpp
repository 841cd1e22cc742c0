// SPDX-License-Identifier: Apache-2.0
#include "armature/messages/known_types.hpp"

#include <mutex>
#include <stdexcept>

#include "armature/messages/message_library.hpp"

namespace armature {
namespace {

/// Of this process. Libraries are loaded by any thread.
struct Known {
  std::mutex mutex;
  TypeDescriptions descriptions;
  std::vector<MessageLibrary::Get> types;
};

Known& known() {
  static Known known;
  return known;
}

}  // namespace

Expected<void> add_descriptions(std::string_view idl, std::string_view file) {
  const std::scoped_lock lock{known().mutex};
  return known().descriptions.add(idl, file);
}

const TypeDescription* describe_type(std::string_view name) {
  const std::scoped_lock lock{known().mutex};
  return known().descriptions.find(name);
}

MessageLibrary::MessageLibrary(const char* idl) {
  if (const auto added = add_descriptions(idl, "message library"); !added) {
    refused_ = added.error().text;
  }
}

bool MessageLibrary::make_known(const std::vector<Get>& types) const {
  if (!refused_.empty()) return false;
  const std::scoped_lock lock{known().mutex};
  known().types.insert(known().types.end(), types.begin(), types.end());
  return true;
}

const TypeDescription& MessageLibrary::description(std::string_view dds_name) const {
  if (!refused_.empty()) {
    throw std::logic_error{std::string{dds_name} + " cannot be used: " + refused_};
  }
  return *describe_type(dds_name);
}

std::vector<const MessageType*> known_message_types() {
  std::vector<MessageLibrary::Get> all;
  {
    const std::scoped_lock lock{known().mutex};
    all = known().types;
  }
  std::vector<const MessageType*> types;
  for (const MessageLibrary::Get get : all) types.push_back(&get());
  return types;
}

const MessageType* find_message_type(std::string_view name) {
  for (const MessageType* type : known_message_types()) {
    if (type->ros_name == name || type->dds_name == name) return type;
  }
  return nullptr;
}

}  // namespace armature
