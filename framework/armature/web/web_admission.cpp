// SPDX-License-Identifier: Apache-2.0
#include "armature/web/web_admission.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>

#include "armature/config/problems.hpp"

namespace armature {
namespace {

enum Status : unsigned { kBadRequest = 400, kForbidden = 403, kUnavailable = 503 };

constexpr std::size_t kMostClients = 32;  // each may make the server keep a whole queue

/// Without telling by its time how much of it is right.
bool same_token(std::string_view a, std::string_view b) {
  unsigned different = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    different |= static_cast<unsigned char>(a[i] ^ b[i]);
  }
  return different == 0;
}

/// True where one of the names in `list`, which commas separate, is among `known`.
bool has_one_of(std::string_view list, const std::vector<std::string>& known) {
  constexpr std::string_view kBlank = " \t";
  while (!list.empty()) {
    std::string_view name = list.substr(0, list.find(','));
    list.remove_prefix(std::min(list.size(), name.size() + 1));
    name.remove_prefix(std::min(name.size(), name.find_first_not_of(kBlank)));
    name = name.substr(0, name.find_last_not_of(kBlank) + 1);
    if (std::ranges::find(known, name) != known.end()) return true;
  }
  return false;
}

/// A browser says where a page came from; other programs need not.
bool is_origin_allowed(const Visitor& visitor, const WebServer::Options& options, int port) {
  if (visitor.origin.empty()) return true;
  const std::string bound = fmt::format("{}:{}", options.address, port);
  // The token was right where there is one: a name that somebody else bends to this machine has
  // none.
  const bool is_own = visitor.origin == "http://" + visitor.host &&
                      (visitor.host == bound || visitor.host == fmt::format("localhost:{}", port) ||
                       !options.token.empty());
  return is_own || std::ranges::find(options.origins, visitor.origin) != options.origins.end();
}

}  // namespace

std::optional<NotAdmitted> admission(const Visitor& visitor, const WebServer::Options& options,
                                     int port, std::size_t clients) {
  if (!has_one_of(visitor.protocols, options.protocols)) {
    const std::string spoken = fmt::format("{}", fmt::join(options.protocols, " or "));
    const std::string asked = visitor.protocols.empty()
                                  ? "no subprotocol"
                                  : "the subprotocol " + config::in_quotes(visitor.protocols);
    return NotAdmitted{
        .told = {.about = visitor.address + ", its protocol",
                 .why = fmt::format("a WebSocket client at {} was refused: it asks for {}, and "
                                    "only {} is spoken here",
                                    visitor.address, asked, spoken)},
        .status = kBadRequest,
        .answer = fmt::format("Ask for the WebSocket subprotocol {}: no other is spoken here.\n",
                              spoken)};
  }
  if (!options.token.empty() && !same_token(visitor.token, options.token)) {
    const std::string why =
        "a client was refused that does not know the token: it belongs into the address, "
        "/?token=...";
    return NotAdmitted{
        .told = {.about = why, .why = why},
        .status = kForbidden,
        .answer = "The token is missing or wrong: it belongs into the address, /?token=...\n"};
  }
  if (is_origin_allowed(visitor, options, port)) {
    if (clients < kMostClients) return std::nullopt;
    const std::string full =
        fmt::format("{} clients are connected, and no more are let in", clients);
    return NotAdmitted{.told = {.about = "the number of clients",
                                .why = fmt::format("a WebSocket client at {} was refused: {}",
                                                   visitor.address, full)},
                       .status = kUnavailable,
                       .answer = full + ".\n"};
  }
  const std::string why = fmt::format("a page from {0} was refused; to let it in: {1} {0}",
                                      config::in_quotes(visitor.origin), options.origin_option);
  return NotAdmitted{
      .told = {.about = why, .why = why},
      .status = kForbidden,
      .answer = fmt::format("Pages from elsewhere are let in with {}.\n", options.origin_option)};
}

}  // namespace armature
