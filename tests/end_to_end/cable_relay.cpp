// SPDX-License-Identifier: Apache-2.0
// A cable with faults of its own, between two interfaces: what comes in at one end goes out at the
// other, late, twice or never, by a seed, since not every kernel can do that itself. Says "ready",
// and what went through when it is told to end.
#include <arpa/inet.h>
#include <linux/if_ether.h>
#include <linux/if_packet.h>
#include <net/if.h>
#include <netinet/ip.h>
#include <netinet/udp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <queue>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;
using Frame = std::vector<unsigned char>;

volatile std::sig_atomic_t g_ended = 0;

struct Faults {
  std::uint64_t seed = 1;
  double lost = 0, doubled = 0;        // share of the frames
  double delay_ms = 0, jitter_ms = 0;  // of each; with jitter a later one may overtake
  bool multicast = true;
  std::string counted;  // frames that contain this text
};

/// The raw end of an interface.
int open_end(const std::string& name) {
  const int end = socket(AF_PACKET, SOCK_RAW | SOCK_CLOEXEC, htons(ETH_P_ALL));
  sockaddr_ll address{};
  address.sll_family = AF_PACKET;
  address.sll_protocol = htons(ETH_P_ALL);
  address.sll_ifindex = static_cast<int>(if_nametoindex(name.c_str()));
  const int on = 1, bytes = 4 << 20;
  const bool opened = end >= 0 && address.sll_ifindex != 0 &&
                      bind(end, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
                      setsockopt(end, SOL_PACKET, PACKET_IGNORE_OUTGOING, &on, sizeof on) == 0 &&
                      setsockopt(end, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof bytes) == 0;
  if (opened) return end;
  std::perror(name.c_str());
  std::exit(1);
}

/// The checksum of a datagram that has never been on a wire is not filled in; 0 says so.
void clear_checksum(Frame& frame) {
  constexpr std::size_t kIp = ETH_HLEN;
  if (frame.size() < kIp + sizeof(iphdr) || frame[12] != 0x08 || frame[13] != 0x00) return;
  iphdr ip{};
  std::memcpy(&ip, frame.data() + kIp, sizeof ip);
  const std::size_t udp = kIp + ip.ihl * 4U;
  const bool first = (ntohs(ip.frag_off) & IP_OFFMASK) == 0;
  if (ip.protocol != IPPROTO_UDP || !first || frame.size() < udp + sizeof(udphdr)) return;
  std::memset(frame.data() + udp + offsetof(udphdr, check), 0, sizeof(udphdr::check));
}

bool is_multicast_ip(const Frame& frame) { return frame[0] == 0x01 && frame[1] == 0x00; }

class Relay {
 public:
  Relay(const std::string& left, const std::string& right, const Faults& faults)
      : faults_{faults}, ends_{open_end(left), open_end(right)}, random_{faults.seed} {}

  void run() {
    while (!g_ended) {
      std::array<pollfd, 2> readable{{{ends_[0], POLLIN, 0}, {ends_[1], POLLIN, 0}}};
      poll(readable.data(), readable.size(), late_.empty() ? 20 : 1);
      for (std::size_t from : {0U, 1U}) {
        if (readable[from].revents & POLLIN) take(from);
      }
      for (; !late_.empty() && late_.top().at <= Clock::now(); late_.pop()) send(late_.top());
    }
    std::printf("through %llu lost %llu doubled %llu counted %llu\n", through_, lost_, doubled_,
                counted_);
  }

 private:
  struct Late {
    Clock::time_point at;
    std::size_t to;
    Frame frame;
    bool operator<(const Late& other) const { return at > other.at; }
  };

  double chance() { return std::uniform_real_distribution{0.0, 1.0}(random_); }

  void take(std::size_t from) {
    Frame frame(65600);
    const ssize_t size = recv(ends_[from], frame.data(), frame.size(), MSG_DONTWAIT);
    if (size < ETH_HLEN) return;
    frame.resize(static_cast<std::size_t>(size));
    if (!faults_.multicast && is_multicast_ip(frame)) return;
    const bool lost = chance() < faults_.lost, doubled = chance() < faults_.doubled;
    if (lost) {
      ++lost_;
      return;
    }
    clear_checksum(frame);
    const std::string_view text{reinterpret_cast<const char*>(frame.data()), frame.size()};
    if (!faults_.counted.empty() && text.find(faults_.counted) != text.npos) ++counted_;
    if (doubled) {
      ++doubled_;
      keep(1 - from, frame);
    }
    keep(1 - from, std::move(frame));
  }

  void keep(std::size_t to, Frame frame) {
    const std::chrono::duration<double, std::milli> delay{faults_.delay_ms +
                                                          faults_.jitter_ms * chance()};
    late_.push(
        {Clock::now() + std::chrono::duration_cast<Clock::duration>(delay), to, std::move(frame)});
  }

  void send(const Late& late) {
    if (::send(ends_[late.to], late.frame.data(), late.frame.size(), 0) > 0) ++through_;
  }

  const Faults faults_;
  std::array<int, 2> ends_;
  std::mt19937_64 random_;
  std::priority_queue<Late> late_;
  unsigned long long through_ = 0, lost_ = 0, doubled_ = 0, counted_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"A cable with faults between two interfaces"};
  std::string left, right;
  Faults faults;
  app.add_option("left", left)->required();
  app.add_option("right", right)->required();
  app.add_option("--seed", faults.seed);
  app.add_option("--lost", faults.lost);
  app.add_option("--doubled", faults.doubled);
  app.add_option("--delay-ms", faults.delay_ms);
  app.add_option("--jitter-ms", faults.jitter_ms);
  app.add_flag("--no-multicast{false}", faults.multicast);
  app.add_option("--count", faults.counted);
  CLI11_PARSE(app, argc, argv);
  for (const int signal : {SIGTERM, SIGINT}) std::signal(signal, [](int) { g_ended = 1; });
  Relay relay{left, right, faults};
  std::puts("ready");
  std::fflush(stdout);
  relay.run();
}
