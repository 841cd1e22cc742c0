// SPDX-License-Identifier: Apache-2.0
#include "armature/web/web_server.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <thread>
#include <vector>

#include "armature/web/web_socket.hpp"
#include "tests/http.hpp"

namespace armature {
namespace {

using test::HttpClient;

const std::string kProtocol = "Sec-WebSocket-Protocol: lamp.v1\r\n";

/// A server whose thread serves, and sends on the word of the test.
class WebServerTest : public testing::Test {
 protected:
  explicit WebServerTest(WebServer::Options options = {.protocols = {"lamp.v1"},
                                                       .origins = {"https://lamp.example"},
                                                       .queue_bytes = 64 << 10})
      : server_{std::move(options),
                {.opened =
                     [this](WebServer::Client client, std::string_view protocol) {
                       protocol_ = protocol == "lamp.v1";
                       last_ = client;
                     },
                 .closed = [this](WebServer::Client) { ++closed_; },
                 .said =
                     [this](WebServer::Client client, std::string_view text) {
                       if (text == "much") return say_much(client);
                       server_.send(client, "heard " + std::string{text});
                     },
                 .said_binary =
                     [this](WebServer::Client client, std::string_view bytes) {
                       server_.send_for_sure(client, std::as_bytes(std::span{bytes}));
                     },
                 .woken = [this] { send_all(); },
                 .refused = [this](const WebServer::Refusal& one) { refusals_.push_back(one); }}},
        thread_{[this] {
          while (!ends_) server_.serve();
        }} {}
  ~WebServerTest() override { end(); }
  void end() {
    ends_ = true;
    if (thread_.joinable()) thread_.join();
  }

  /// Messages of 1 kB with their numbers, to every client there has been.
  void send_all() {
    for (int i = 0; i < to_send_; ++i) {
      auto body = std::make_shared<std::vector<std::byte>>(1024);
      std::memcpy(body->data(), &sent_, sizeof sent_);
      ++sent_;
      const std::array<std::byte, 1> head{std::byte{7}};
      for (WebServer::Client client = 1; client <= last_; ++client) {
        server_.send(client, head, body);
      }
    }
    dropped_of_first_ = server_.dropped(1);
    ++rounds_;
  }
  /// Ten times what waits for a client, in texts of 1 kB.
  void say_much(WebServer::Client client) {
    for (int i = 0; i < 640; ++i) server_.send(client, std::string(1024, 'x'));
  }
  bool opens(const std::string& headers, const std::string& path = "/") {
    return WebSocket{server_.port(), headers, path}.is_open();
  }

  std::atomic<WebServer::Client> last_{0};
  std::atomic<int> closed_{0}, to_send_{0}, rounds_{0};
  std::atomic<std::uint64_t> dropped_of_first_{0};
  std::atomic<bool> ends_{false}, protocol_{false};
  int sent_ = 0;
  std::vector<WebServer::Refusal> refusals_;  // of the thread that serves, read when it has ended
  WebServer server_;
  std::thread thread_;
};

TEST_F(WebServerTest, AnswersWhoSpeaksItsProtocol) {
  WebSocket socket{server_.port(), kProtocol};
  ASSERT_TRUE(socket.is_open());
  socket.send_text("light");
  const auto frame = socket.next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->op, 1);
  EXPECT_EQ(frame->payload, "heard light");
  EXPECT_TRUE(protocol_) << "the server is told which protocol it is";
}

TEST_F(WebServerTest, KnowsABinaryMessageFromAText) {
  WebSocket socket{server_.port(), kProtocol};
  socket.send_binary(std::string{"\0\1", 2});
  const auto frame = socket.next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->op, 2);
  EXPECT_EQ(frame->payload, (std::string{"\0\1", 2}));
}

TEST_F(WebServerTest, RefusesWhoAsksForNoProtocolOrAnother) {
  EXPECT_FALSE(opens(""));
  EXPECT_FALSE(opens("Sec-WebSocket-Protocol: other.v1\r\n"));
  EXPECT_FALSE(opens("Sec-WebSocket-Protocol: http-only\r\n"));
  for (const std::string other : {"other.v1", "http-only"}) {
    EXPECT_TRUE(opens("Sec-WebSocket-Protocol: " + other + ", lamp.v1\r\n")) << other;
  }
}

TEST_F(WebServerTest, TellsWhoAsksForNoProtocolOrAnotherWhichOneItSpeaks) {
  const std::string other = "Sec-WebSocket-Protocol: other.v1<b>, more\r\n";
  const std::string long_one = "Sec-WebSocket-Protocol: " + std::string(700, 'x') + "\r\n";
  for (const std::string& headers : {std::string{}, other, long_one}) {
    const WebSocket socket{server_.port(), headers};
    EXPECT_TRUE(socket.answer().starts_with("HTTP/1.0 400 ")) << socket.answer();
    EXPECT_NE(socket.answer().find("Ask for the WebSocket subprotocol lamp.v1"), std::string::npos)
        << socket.answer();
    EXPECT_EQ(socket.answer().find("<b>"), std::string::npos) << "nothing that it said itself";
  }
  EXPECT_TRUE(opens(kProtocol)) << "the server goes on";
  end();
  ASSERT_EQ(refusals_.size(), 3U);
  EXPECT_EQ(refusals_[0].why,
            "a WebSocket client at 127.0.0.1 was refused: it asks for no subprotocol, and only "
            "lamp.v1 is spoken here");
  EXPECT_EQ(refusals_[1].why,
            "a WebSocket client at 127.0.0.1 was refused: it asks for the subprotocol "
            "'other.v1<b>, more', and only lamp.v1 is spoken here");
  EXPECT_NE(refusals_[2].why.find("'xxxxx"), std::string::npos) << refusals_[2].why;
  EXPECT_EQ(refusals_[0].about, refusals_[1].about) << "one need be told once of an address";
}

TEST_F(WebServerTest, AnswersPagesOfForeignOriginsThatTheyAreNotLetIn) {
  const WebSocket socket{server_.port(), kProtocol + "Origin: https://evil.example\r\n"};
  EXPECT_TRUE(socket.answer().starts_with("HTTP/1.0 403 ")) << socket.answer();
  EXPECT_NE(socket.answer().find("are let in with --origin"), std::string::npos);
}

TEST_F(WebServerTest, RefusesPagesOfForeignOrigins) {
  const std::string own = std::to_string(server_.port());
  EXPECT_TRUE(opens(kProtocol + "Origin: https://lamp.example\r\n"));
  EXPECT_TRUE(opens(kProtocol + "Origin: http://127.0.0.1:" + own + "\r\n"));
  EXPECT_FALSE(opens(kProtocol + "Origin: https://evil.example\r\n"));
  EXPECT_FALSE(opens(kProtocol + "Origin: https://lamp.example.evil.example\r\n"));
  EXPECT_FALSE(opens(kProtocol + "Origin: http://127.0.0.1:1\r\n"));
  EXPECT_FALSE(opens(kProtocol + "Origin: null\r\n"));
}

TEST_F(WebServerTest, TakesAsManyClientsAsItSaysAndAnotherOneOnceOneHasLeft) {
  std::vector<std::unique_ptr<WebSocket>> clients;
  for (int i = 0; i < 32; ++i) {
    clients.push_back(std::make_unique<WebSocket>(server_.port(), kProtocol));
    ASSERT_TRUE(clients.back()->is_open()) << i;
  }
  for (int i = 0; i < 3; ++i) {
    const WebSocket one_more{server_.port(), kProtocol};
    EXPECT_FALSE(one_more.is_open());
    EXPECT_TRUE(one_more.answer().starts_with("HTTP/1.0 503 ")) << one_more.answer();
    EXPECT_NE(one_more.answer().find("32 clients are connected, and no more are let in"),
              std::string::npos)
        << one_more.answer();
  }
  clients.front()->send_text("light");
  const auto frame = clients.front()->next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->payload, "heard light") << "who is there already is served";
  clients.pop_back();
  for (int i = 0; i < 500 && closed_ == 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds{10});
  }
  EXPECT_TRUE(opens(kProtocol));
  end();
  ASSERT_EQ(refusals_.size(), 3U);
  EXPECT_EQ(refusals_[0].why,
            "a WebSocket client at 127.0.0.1 was refused: 32 clients are connected, and no more "
            "are let in");
  EXPECT_EQ(refusals_[0].about, refusals_[2].about) << "one need be told once";
}

TEST_F(WebServerTest, AClientThatDoesNotReadLosesItsOldestMessagesAndSlowsNobody) {
  WebSocket lazy{server_.port(), kProtocol}, reader{server_.port(), kProtocol};
  ASSERT_TRUE(lazy.is_open() && reader.is_open());
  constexpr int kRounds = 500, kOfRound = 40;
  to_send_ = kOfRound;
  for (int round = 0, expected = 0; round < kRounds; ++round) {
    server_.wake();
    for (int i = 0; i < kOfRound; ++i, ++expected) {
      const auto frame = reader.next();
      ASSERT_TRUE(frame);
      int number = -1;
      std::memcpy(&number, frame->payload.data() + 1, sizeof number);
      ASSERT_EQ(number, expected);
    }
  }
  EXPECT_GT(dropped_of_first_, 0U) << "of 20 MB";
  // The lazy one reads at last, in order and to the newest.
  int last = -1, number = -1;
  while (number != kRounds * kOfRound - 1) {
    const auto frame = lazy.next();
    ASSERT_TRUE(frame);
    std::memcpy(&number, frame->payload.data() + 1, sizeof number);
    ASSERT_GT(number, last);
    last = number;
  }
}

TEST_F(WebServerTest, WhoIsClosedIsToldWhyAsSoonAsItReads) {
  WebSocket lazy{server_.port(), kProtocol};
  ASSERT_TRUE(lazy.is_open());
  lazy.send_text("much");
  std::optional<WebSocket::Frame> last = lazy.next();
  while (last && last->op != 8) last = lazy.next();
  ASSERT_TRUE(last) << "no close";
  ASSERT_GT(last->payload.size(), 2U);
  EXPECT_EQ(last->payload.substr(2), "too little of what was sent is read");
}

TEST_F(WebServerTest, WhoSaysTooMuchIsShownOut) {
  WebSocket socket{server_.port(), kProtocol};
  for (int i = 0; i < 100 && socket.is_open(); ++i) {
    socket.send_part(std::string(60'000, 'x'), i == 0);
  }
  for (int i = 0; i < 500 && closed_ == 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds{10});
  }
  EXPECT_EQ(closed_, 1) << "6 MB without an end";
  WebSocket other{server_.port(), kProtocol};
  EXPECT_TRUE(other.is_open()) << "the server goes on";
}

class WebServerWithRoom : public WebServerTest {
 protected:
  WebServerWithRoom() : WebServerTest{{.protocols = {"lamp.v1"}, .queue_bytes = 1 << 20}} {}
};

TEST_F(WebServerWithRoom, ClosesWhoSaysMuchAndReadsNoAnswer) {
  WebSocket lazy{server_.port(), kProtocol}, reader{server_.port(), kProtocol};
  ASSERT_TRUE(lazy.is_open() && reader.is_open());
  // Answers of 300 MB; sockets keep the first of them until they take no more.
  for (int i = 0; i < 5000 && lazy.is_open(); ++i) lazy.send_text(std::string(60'000, 'x'));
  for (int i = 0; i < 2000 && closed_ == 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds{10});
  }
  EXPECT_EQ(closed_, 1);
  reader.send_text("light");
  const auto frame = reader.next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->payload, "heard light") << "nobody else is";
  end();
  ASSERT_EQ(refusals_.size(), 1U);
  EXPECT_EQ(refusals_[0].why,
            "a WebSocket client at 127.0.0.1 was closed: it reads too little of what it is sent, "
            "and more than 1048576 bytes wait for it");
}

class WebServerWithToken : public WebServerTest {
 protected:
  WebServerWithToken() : WebServerTest{{.protocols = {"lamp.v1"}, .token = "secret"}} {}
};

TEST_F(WebServerWithToken, RefusesWhoDoesNotKnowIt) {
  EXPECT_FALSE(opens(kProtocol));
  EXPECT_FALSE(opens(kProtocol, "/?token=secre"));
  EXPECT_FALSE(opens(kProtocol, "/?token=secretsecret"));
  EXPECT_TRUE(opens(kProtocol, "/?token=secret"));
}

TEST_F(WebServerWithToken, LetsItsOwnPageInByWhateverNameTheMachineHas) {
  const std::string port = std::to_string(server_.port()), host = "lamp.local:" + port;
  const std::string page = kProtocol + "Origin: http://" + host + "\r\n";
  EXPECT_TRUE(WebSocket(server_.port(), page, "/?token=secret", host).is_open());
  EXPECT_FALSE(WebSocket(server_.port(), page, "/?token=wrong", host).is_open());
  EXPECT_FALSE(WebSocket(server_.port(), page, "/?token=secret").is_open()) << "of another host";
}

TEST_F(WebServerTest, RefusesANameThatSomebodyElseBendsToThisMachine) {
  const std::string host = "evil.example:" + std::to_string(server_.port());
  EXPECT_FALSE(WebSocket(server_.port(), kProtocol + "Origin: http://" + host + "\r\n", "/", host)
                   .is_open());
}

/// A page that is larger than what a connection takes at once.
class WebServerWithPage : public WebServerTest {
 protected:
  WebServerWithPage()
      : WebServerTest{{.protocols = {"lamp.v1"},
                       .page = {.text = page(),
                                .type = "text/html; charset=utf-8",
                                .security_policy = "default-src 'none'; script-src 'self'"}}} {}
  static std::string page() {
    std::string text;
    while (text.size() < (3U << 20)) text += std::to_string(text.size()) + " light\n";
    return text;
  }
};

TEST_F(WebServerWithPage, GivesItWholeWithWhatItMayDo) {
  const std::string answer = HttpClient{server_.port(), "GET /"}.read_all();
  const std::size_t end = answer.find("\r\n\r\n");
  ASSERT_NE(end, std::string::npos) << answer.substr(0, 100);
  const std::string head = answer.substr(0, end);
  EXPECT_TRUE(head.starts_with("HTTP/1.1 200 "));
  EXPECT_NE(head.find("content-security-policy: default-src 'none'; script-src 'self'\r\n"),
            std::string::npos)
      << head;
  EXPECT_NE(head.find("content-type: text/html; charset=utf-8\r\n"), std::string::npos) << head;
  EXPECT_NE(head.find("cache-control: no-store"), std::string::npos) << head;
  EXPECT_TRUE(answer.substr(end + 4) == page()) << answer.size() - end - 4 << " bytes";
}

TEST_F(WebServerWithPage, GivesTheHeadAloneToWhoAsksForThat) {
  const std::string answer = HttpClient{server_.port(), "HEAD /"}.read_all();
  EXPECT_TRUE(answer.starts_with("HTTP/1.1 200 ")) << answer;
  EXPECT_TRUE(answer.ends_with("\r\n\r\n")) << answer;
  EXPECT_NE(answer.find("content-length: " + std::to_string(page().size())), std::string::npos);
}

TEST_F(WebServerWithPage, HasNothingElseAndTakesNothing) {
  EXPECT_TRUE(HttpClient(server_.port(), "GET /secret").read_all().starts_with("HTTP/1.1 404 "));
  EXPECT_TRUE(
      HttpClient(server_.port(), "GET /../etc/passwd").read_all().starts_with("HTTP/1.1 404 "));
  EXPECT_TRUE(HttpClient(server_.port(), "POST /").read_all().starts_with("HTTP/1.1 405 "));
}

TEST_F(WebServerWithPage, BrowsersThatReadNothingOfItSlowNobody) {
  std::vector<std::unique_ptr<HttpClient>> lazy;
  for (int i = 0; i < 10; ++i) {
    lazy.push_back(std::make_unique<HttpClient>(server_.port(), "GET /"));
  }
  WebSocket socket{server_.port(), kProtocol};
  ASSERT_TRUE(socket.is_open());
  for (int i = 0; i < 100; ++i) {
    socket.send_text(std::to_string(i));
    const auto frame = socket.next();
    ASSERT_TRUE(frame);
    ASSERT_EQ(frame->payload, "heard " + std::to_string(i));
  }
  EXPECT_TRUE(HttpClient(server_.port(), "GET /").read_all().ends_with(page().substr(1U << 20)));
}

TEST(WebServer, SaysThatItsPortIsTaken) {
  WebServer first{{.protocols = {"lamp.v1"}}, {}};
  try {
    WebServer{{.port = first.port(), .protocols = {"lamp.v1"}}, {}};
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string{error.what()}.find("cannot listen at 127.0.0.1:"), std::string::npos);
  }
}

}  // namespace
}  // namespace armature
