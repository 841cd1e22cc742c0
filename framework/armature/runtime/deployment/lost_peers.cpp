// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/deployment/lost_peers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace armature {
namespace {

/// "(pid 12 on host)"; without one the whole note.
std::string_view place_in(std::string_view note) {
  const std::size_t begin = note.rfind("(pid ");
  const std::size_t end = note.find(')', std::min(begin, note.size()));
  return end == std::string_view::npos ? note : note.substr(begin, end + 1 - begin);
}

}  // namespace

LostPeers::LostPeers(std::string deployment, std::vector<std::string> processes, std::string own)
    : deployment_{std::move(deployment)}, processes_{std::move(processes)}, own_{std::move(own)} {}

/// A writer is "of deployment 'lamp', process 'vision'", a participant is called "armature lamp,
/// process 'vision'".
bool LostPeers::is_of(std::string_view note, const std::string& process) const {
  return note.find(fmt::format("'{}', process '{}'", deployment_, process)) != note.npos ||
         note.find(fmt::format("armature {}, process '{}'", deployment_, process)) != note.npos;
}

bool LostPeers::is_told_here(std::string_view note) {
  const auto first = std::ranges::find_if(
      processes_, [&](const std::string& process) { return !is_of(note, process); });
  if (first == processes_.end() || *first != own_) return false;
  const std::string place{place_in(note)};
  if (reported_.find(place)) return false;
  reported_.put(place, {});
  return true;
}

}  // namespace armature
