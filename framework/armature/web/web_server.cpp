// SPDX-License-Identifier: Apache-2.0
#include "armature/web/web_server.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <libwebsockets.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <stdexcept>
#include <utility>

#include "armature/web/outgoing_queue.hpp"
#include "armature/web/web_admission.hpp"

namespace armature {
namespace {

constexpr std::size_t kLongestText = 1U << 20;      // [byte] of what a client says
constexpr const char* kNoProtocol = "no protocol";  // none that a client offers has a blank
constexpr std::size_t kPagePart = 32U << 10;        // [byte] of a page, at a time
constexpr int kPagePatience_s = 20;                 // for who reads no part of it
constexpr int kFarewell_s = 2;                      // to take the reason why it is closed
constexpr std::string_view kFarewell = "too little of what was sent is read";

std::string header_of(lws* connection, lws_token_indexes header) {
  std::string text(static_cast<std::size_t>(lws_hdr_total_length(connection, header)) + 1, '\0');
  const int length = lws_hdr_copy(connection, text.data(), static_cast<int>(text.size()), header);
  text.resize(static_cast<std::size_t>(std::max(length, 0)));
  return text;
}

struct Session {
  lws* connection = nullptr;
  OutgoingQueue queue;
  std::uint64_t dropped = 0;
  std::string heard;  // the beginning of a message
  bool is_shown_out = false;
};

/// Ends the wait of lws_service.
struct Round {
  lws_sorted_usec_list_t timer{};  // the first member: its callback finds the rest behind it
  lws_context* context = nullptr;

  void begin(lws_context* of, lws_usec_t us) {
    context = of;
    lws_sul_schedule(context, 0, &timer, &over, us);
  }
  /// It may be over before the wait begins, which would then have no end: another one follows.
  static void over(lws_sorted_usec_list_t* timer) {
    constexpr lws_usec_t kNext_us = 10'000;
    auto* round = reinterpret_cast<Round*>(timer);
    round->begin(round->context, kNext_us);
  }
};

}  // namespace

class WebServer::Impl {
 public:
  Impl(Options options, Events events) : options_{std::move(options)}, events_{std::move(events)} {
    lws_set_log_level(0, nullptr);
    // A client that asks for no protocol gets the first one, which none may use.
    protocols_.push_back({.name = kNoProtocol, .callback = &Impl::call});
    for (const std::string& name : options_.protocols) {
      protocols_.push_back(
          {.name = name.c_str(), .callback = &Impl::call, .per_session_data_size = sizeof(Client)});
    }
    protocols_.push_back({});
    lws_context_creation_info info{};
    info.port = options_.port;
    info.iface = options_.address.c_str();
    info.protocols = protocols_.data();
    info.user = this;
    info.gid = static_cast<gid_t>(-1);
    info.uid = static_cast<uid_t>(-1);
    info.options = LWS_SERVER_OPTION_VALIDATE_UTF8 | LWS_SERVER_OPTION_DISABLE_IPV6 |
                   LWS_SERVER_OPTION_EXPLICIT_VHOSTS | LWS_SERVER_OPTION_FAIL_UPON_UNABLE_TO_BIND;
    context_ = lws_create_context(&info);
    vhost_ = context_ ? lws_create_vhost(context_, &info) : nullptr;
    if (vhost_) return;
    if (context_) lws_context_destroy(context_);
    throw std::runtime_error(
        fmt::format("cannot listen at {}:{}: another program is there, or the address is not of "
                    "this machine; take another port, or 0 for any that is free",
                    options_.address, options_.port));
  }
  ~Impl() {
    ends_ = true;  // whom the events are for may be gone
    lws_context_destroy(context_);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  int port() const { return lws_get_vhost_listen_port(vhost_); }
  void serve(Duration at_most) {
    constexpr std::int64_t kShortest_us = 1000;  // what is over sooner is over before it waits
    const auto us = std::chrono::duration_cast<std::chrono::microseconds>(at_most).count();
    round_.begin(context_, std::max(us, kShortest_us));
    lws_service(context_, 0);
  }
  void wake() { lws_cancel_service(context_); }

  void send(Client client, Outgoing message) {
    const auto found = sessions_.find(client);
    if (found == sessions_.end()) return;
    Session& session = found->second;
    if (session.is_shown_out) return;
    const bool may_drop = message.may_drop;
    const std::size_t alone = message.room();
    session.queue.put(std::move(message));
    while (session.queue.bytes() > options_.queue_bytes && session.queue.drop_oldest()) {
      ++session.dropped;
    }
    // One that must arrive may be larger than the queue: a long list of topics.
    if (!may_drop && session.queue.bytes() > std::max(options_.queue_bytes, alone)) {
      return show_out(session);
    }
    lws_callback_on_writable(session.connection);
  }
  bool is_behind(Client client) const {
    const auto found = sessions_.find(client);
    return found != sessions_.end() && found->second.queue.has_lasting();
  }
  std::uint64_t dropped(Client client) const {
    const auto found = sessions_.find(client);
    return found == sessions_.end() ? 0 : found->second.dropped;
  }

 private:
  static int call(lws* connection, lws_callback_reasons reason, void* user, void* in,
                  std::size_t size) {
    lws_context* context = lws_get_context(connection);
    auto* self = context ? static_cast<Impl*>(lws_context_user(context)) : nullptr;
    return self ? self->handle(connection, reason, static_cast<Client*>(user), in, size) : 0;
  }

  int handle(lws* connection, lws_callback_reasons reason, Client* client, void* in,
             std::size_t size) {
    const bool is_of_session = reason == LWS_CALLBACK_RECEIVE || reason == LWS_CALLBACK_CLOSED ||
                               reason == LWS_CALLBACK_SERVER_WRITEABLE;
    if (ends_) return 0;
    if (is_of_session && (!client || !sessions_.contains(*client))) return 0;  // was refused
    switch (reason) {
      case LWS_CALLBACK_HTTP: return answer_browser(connection);
      case LWS_CALLBACK_HTTP_WRITEABLE: return write_page(connection);
      case LWS_CALLBACK_CLOSED_HTTP: page_written_.erase(connection); return 0;
      case LWS_CALLBACK_HTTP_CONFIRM_UPGRADE: return admit(connection);
      case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:
        return lws_get_protocol(connection) == first_protocol() ? 1 : 0;
      case LWS_CALLBACK_ESTABLISHED:
        *client = ++last_client_;
        sessions_[*client].connection = connection;
        events_.opened(*client, lws_get_protocol(connection)->name);
        return 0;
      case LWS_CALLBACK_RECEIVE:
        return hear(connection, *client, {static_cast<const char*>(in), size});
      case LWS_CALLBACK_SERVER_WRITEABLE: return write_next(connection, sessions_.at(*client));
      case LWS_CALLBACK_CLOSED:
        events_.closed(*client);
        sessions_.erase(*client);
        return 0;
      case LWS_CALLBACK_EVENT_WAIT_CANCELLED:  // told to each protocol
        if (lws_get_protocol(connection) == first_protocol()) events_.woken();
        return 0;
      default: return 0;
    }
  }

  const lws_protocols* first_protocol() const {
    return lws_vhost_name_to_protocol(vhost_, kNoProtocol);
  }

  Visitor visitor_of(lws* connection) const {
    std::array<char, kMaxTokenBytes + 16> argument{};
    std::array<char, 512> address{};
    const char* token = lws_get_urlarg_by_name(connection, "token=", argument.data(),
                                               static_cast<int>(argument.size()));
    const char* peer = lws_get_peer_simple(connection, address.data(), address.size());
    return {.address = peer ? peer : "an unknown address",
            .protocols = header_of(connection, WSI_TOKEN_PROTOCOL),
            .token = token ? token : "",
            .origin = header_of(connection, WSI_TOKEN_ORIGIN),
            .host = header_of(connection, WSI_TOKEN_HOST)};
  }

  /// 0: the connection becomes a WebSocket; above: it was refused with an answer; below: it is
  /// shut.
  int admit(lws* connection) const {
    const auto refused = admission(visitor_of(connection), options_, port(), sessions_.size());
    if (!refused) return 0;
    events_.refused(refused->told);
    const int result = lws_return_http_status(connection, refused->status, refused->answer.c_str());
    return result < 0 ? -1 : 1;
  }

  int answer_browser(lws* connection) {
    const bool gets = lws_hdr_total_length(connection, WSI_TOKEN_GET_URI) > 0;
    const bool asks_head = lws_hdr_total_length(connection, WSI_TOKEN_HEAD_URI) > 0;
    if (!gets && !asks_head) return refuse(connection, HTTP_STATUS_METHOD_NOT_ALLOWED);
    if (header_of(connection, gets ? WSI_TOKEN_GET_URI : WSI_TOKEN_HEAD_URI) != "/") {
      return refuse(connection, HTTP_STATUS_NOT_FOUND);
    }
    if (!write_page_head(connection)) return 1;
    if (asks_head || options_.page.text.empty()) return completed(connection);
    page_written_[connection] = 0;
    lws_callback_on_writable(connection);
    return 0;
  }

  bool write_page_head(lws* connection) const {
    const Page& page = options_.page;
    std::array<unsigned char, LWS_PRE + 4096> buffer{};
    unsigned char* start = buffer.data() + LWS_PRE;
    unsigned char* at = start;
    unsigned char* end = buffer.data() + buffer.size() - 1;
    const auto add = [&](const char* name, const std::string& value) {
      return lws_add_http_header_by_name(connection, reinterpret_cast<const unsigned char*>(name),
                                         reinterpret_cast<const unsigned char*>(value.data()),
                                         static_cast<int>(value.size()), &at, end) == 0;
    };
    return lws_add_http_common_headers(connection, HTTP_STATUS_OK, page.type.c_str(),
                                       page.text.size(), &at, end) == 0 &&
           add("content-security-policy:", page.security_policy) &&
           add("cache-control:", "no-store") &&  // another armature may be at this port tomorrow
           add("referrer-policy:", "no-referrer") &&  // the address may have the token
           add("x-content-type-options:", "nosniff") &&
           lws_finalize_write_http_header(connection, start, &at, end) == 0;
  }

  /// A part of the page: others are served between two of them.
  int write_page(lws* connection) {
    const auto found = page_written_.find(connection);
    if (found == page_written_.end()) return 0;
    const std::string& text = options_.page.text;
    const std::size_t size = std::min(kPagePart, text.size() - found->second);
    scratch_.resize(LWS_PRE + size);
    std::memcpy(scratch_.data() + LWS_PRE, text.data() + found->second, size);
    found->second += size;
    const bool is_last = found->second == text.size();
    if (lws_write(connection, scratch_.data() + LWS_PRE, size,
                  is_last ? LWS_WRITE_HTTP_FINAL : LWS_WRITE_HTTP) < static_cast<int>(size)) {
      return -1;
    }
    if (is_last) {
      page_written_.erase(found);
      return completed(connection);
    }
    lws_set_timeout(connection, PENDING_TIMEOUT_HTTP_CONTENT, kPagePatience_s);
    lws_callback_on_writable(connection);
    return 0;
  }

  static int refuse(lws* connection, unsigned status) {
    return lws_return_http_status(connection, status, nullptr) != 0 ? -1 : completed(connection);
  }
  static int completed(lws* connection) {
    return lws_http_transaction_completed(connection) != 0 ? -1 : 0;
  }

  /// Closes a client as soon as it takes the reason, or a little later without it.
  void show_out(Session& session) const {
    session.is_shown_out = true;
    session.queue.clear();
    std::array<char, 512> address{};
    const char* peer = lws_get_peer_simple(session.connection, address.data(), address.size());
    const std::string who = peer ? peer : "an unknown address";
    events_.refused({.about = who + ", which reads too little",
                     .why = fmt::format("a WebSocket client at {} was closed: it reads too little "
                                        "of what it is sent, and more than {} bytes wait for it",
                                        who, options_.queue_bytes)});
    lws_set_timeout(session.connection, PENDING_TIMEOUT_CLOSE_SEND, kFarewell_s);
    lws_callback_on_writable(session.connection);
  }

  int hear(lws* connection, Client client, std::string_view part) {
    Session& session = sessions_.at(client);
    if (session.is_shown_out) return 0;
    if (session.heard.size() + part.size() > kLongestText) return -1;
    session.heard += part;
    if (lws_is_final_fragment(connection) == 0 || lws_remaining_packet_payload(connection) != 0) {
      return 0;
    }
    const std::string heard = std::exchange(session.heard, {});
    const bool is_binary = lws_frame_is_binary(connection) != 0;
    (is_binary ? events_.said_binary : events_.said)(client, heard);
    return 0;
  }

  int write_next(lws* connection, Session& session) {
    if (session.is_shown_out) {
      std::string why{kFarewell};
      lws_close_reason(connection, LWS_CLOSE_STATUS_POLICY_VIOLATION,
                       reinterpret_cast<unsigned char*>(why.data()), why.size());
      return -1;
    }
    if (session.queue.empty()) return 0;
    const Outgoing message = session.queue.take();
    scratch_.resize(LWS_PRE + message.size());
    unsigned char* at = scratch_.data() + LWS_PRE;
    std::memcpy(at, message.text.data(), message.text.size());
    std::memcpy(at, message.head.data(), message.head_size);
    if (message.body) {
      std::memcpy(at + message.head_size, message.body->data(), message.body->size());
    }
    const int written = lws_write(connection, at, message.size(),
                                  message.binary ? LWS_WRITE_BINARY : LWS_WRITE_TEXT);
    if (written < static_cast<int>(message.size())) return -1;
    if (!session.queue.empty()) lws_callback_on_writable(connection);
    return 0;
  }

  Options options_;
  Events events_;
  std::vector<lws_protocols> protocols_;
  lws_context* context_ = nullptr;
  lws_vhost* vhost_ = nullptr;
  Round round_;
  bool ends_ = false;
  Client last_client_ = 0;
  std::map<Client, Session> sessions_;
  std::map<lws*, std::size_t> page_written_;  // [byte] to each browser that reads it
  std::vector<unsigned char> scratch_;
};

WebServer::WebServer(Options options, Events events)
    : impl_{std::make_unique<Impl>(std::move(options), std::move(events))} {}
WebServer::~WebServer() = default;

int WebServer::port() const { return impl_->port(); }
void WebServer::serve(Duration at_most) { impl_->serve(at_most); }
void WebServer::wake() { impl_->wake(); }

void WebServer::send(Client client, std::string text) {
  impl_->send(client, {.text = std::move(text)});
}

void WebServer::send(Client client, std::span<const std::byte> head, Body body) {
  Outgoing message{
      .binary = true, .may_drop = true, .head_size = head.size(), .body = std::move(body)};
  std::ranges::copy(head, message.head.begin());
  impl_->send(client, std::move(message));
}

void WebServer::send_for_sure(Client client, std::span<const std::byte> message) {
  const auto* bytes = reinterpret_cast<const char*>(message.data());
  impl_->send(client, {.binary = true, .text = {bytes, message.size()}});
}

std::uint64_t WebServer::dropped(Client client) const { return impl_->dropped(client); }
bool WebServer::is_behind(Client client) const { return impl_->is_behind(client); }

}  // namespace armature
