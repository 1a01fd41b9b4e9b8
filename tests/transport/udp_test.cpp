// What goes over sockets of our own, between us and with LCM's library.
#include <arpa/inet.h>
#include <doctest/doctest.h>
#include <linux/if_packet.h>
#include <net/ethernet.h>
#include <net/if.h>
#include <netinet/in.h>
#include <poll.h>
#include <sched.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <iostream>
#include <random>

#include "tests/private_network.hpp"
#include "tests/sample_markers.hpp"
#include "transport/lcm_datagram.hpp"
#include "transport/publisher.hpp"
#include "transport/subscriber.hpp"

using namespace roundel;
using namespace std::chrono_literals;

namespace {

// A port of this process's own: the tests of this file run beside each other.
const auto kPort = static_cast<std::uint16_t>(20000 + ::getpid() % 10000);
const std::string kUrl = "udpm://239.255.76.69:" + std::to_string(kPort) + "?ttl=0";

using Datagram = std::vector<std::uint8_t>;

PublisherParameters parameters() {
  PublisherParameters parameters;
  parameters.channel = "UDP_TEST";
  parameters.camera = "ceiling";
  return parameters;
}

// A sender that knows no rules.
class RawSender {
 public:
  RawSender() : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    target_.sin_family = AF_INET;
    target_.sin_port = htons(kPort);
    ::inet_pton(AF_INET, "239.255.76.69", &target_.sin_addr);
    const unsigned char ttl = 0;
    ::setsockopt(socket_, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl);
  }
  ~RawSender() { ::close(socket_); }
  RawSender(const RawSender&) = delete;
  RawSender& operator=(const RawSender&) = delete;

  void send(const Datagram& datagram) const {
    ::sendto(socket_, datagram.data(), datagram.size(), 0,
             reinterpret_cast<const sockaddr*>(&target_), sizeof target_);
  }

 private:
  int socket_;
  sockaddr_in target_{};
};

// Keeps what is sent, as the datagrams that it would go out in.
class Collector final : public MessageSender {
 public:
  bool send(const char* channel, Bytes message) override {
    Datagram datagram = {'L', 'C', '0', '2', 0, 0, 0, 1};
    datagram.insert(datagram.end(), channel, channel + std::string_view(channel).size() + 1);
    datagram.insert(datagram.end(), message.begin(), message.end());
    datagrams.push_back(std::move(datagram));
    return true;
  }
  std::vector<Datagram> datagrams;
};

std::vector<Datagram> good_datagrams() {
  const auto collector = std::make_shared<Collector>();
  Publisher publisher(collector, parameters());
  for (std::int64_t number = 0; number < 4; ++number) {
    publisher.publish(sample_information(1000 + number), sample_markers(20));
  }
  publisher.publish(status_t{});
  return collector->datagrams;
}

// A fragment of a long message, as LCM's library sends it; every field is the sender's.
Datagram fragment(std::uint32_t size, std::uint32_t offset, std::uint16_t number,
                  std::uint16_t count, std::string_view payload) {
  Datagram datagram = {'L', 'C', '0', '3', 0, 0, 0, 7};
  const auto put = [&](std::uint32_t value, int bytes) {
    for (int i = bytes - 1; i >= 0; --i) {
      datagram.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
    }
  };
  put(size, 4);
  put(offset, 4);
  put(number, 2);
  put(count, 2);
  datagram.insert(datagram.end(), payload.begin(), payload.end());
  return datagram;
}

}  // namespace

TEST_CASE("datagrams of LCM are taken apart, others are none") {
  const Datagram good = {'L', 'C', '0', '2', 0, 0, 0, 1, 'A', 'B', 0, 1, 2, 3};
  const auto parsed = parse_lcm_datagram(good);
  REQUIRE(parsed.has_value());
  CHECK(parsed->channel == "AB");
  CHECK(std::vector<std::uint8_t>(parsed->message.begin(), parsed->message.end()) ==
        std::vector<std::uint8_t>{1, 2, 3});
  for (std::size_t size = 0; size < 11; ++size) {
    CAPTURE(size);
    CHECK_FALSE(parse_lcm_datagram(Bytes(good).first(size)).has_value());
  }
  CHECK(parse_lcm_datagram(Bytes(good).first(11))->message.empty());
  CHECK_FALSE(parse_lcm_datagram(fragment(100, 0, 0, 2, "AB")).has_value());
  Datagram long_channel(80, 'A');
  std::copy_n(good.begin(), 8, long_channel.begin());
  CHECK_FALSE(parse_lcm_datagram(long_channel).has_value());
  long_channel.back() = 0;  // 71 characters
  CHECK_FALSE(parse_lcm_datagram(long_channel).has_value());
}

TEST_CASE("LCM's library understands what is sent") {
  if (!multicast_is_private()) return;
  Subscriber subscriber(open_lcm(kUrl, LcmUse::kReceive), "UDP_TEST");
  Publisher publisher(open_sender(kUrl), parameters());
  publisher.publish(sample_information(5), sample_markers(30));
  const ReceivedFrame* frame = subscriber.next_frame(10s);
  REQUIRE(frame != nullptr);
  CHECK(frame->header.frame == 5);
  CHECK(frame->markers.size() == 30);
}

TEST_CASE("what LCM's library sends is understood") {
  if (!multicast_is_private()) return;
  Subscriber subscriber(kUrl, "UDP_TEST");
  Publisher publisher(open_lcm(kUrl, LcmUse::kSend), parameters());
  publisher.publish(sample_information(6), sample_markers(30));
  const ReceivedFrame* frame = subscriber.next_frame(10s);
  REQUIRE(frame != nullptr);
  CHECK(frame->header.frame == 6);
  CHECK(frame->markers.size() == 30);
}

TEST_CASE("a machine can be sent to alone, and hears it beside the group") {
  if (!multicast_is_private()) return;
  Subscriber subscriber(kUrl, "UDP_TEST");
  Publisher publisher(open_sender("udpm://127.0.0.1:" + std::to_string(kPort)), parameters());
  publisher.publish(sample_information(7), sample_markers(3));
  const ReceivedFrame* frame = subscriber.next_frame(10s);
  REQUIRE(frame != nullptr);
  CHECK(frame->header.frame == 7);
}

TEST_CASE("an interface can be named, and must be there") {
  if (!multicast_is_private()) return;
  Subscriber subscriber(kUrl, "UDP_TEST", "lo");
  Publisher publisher(open_sender(kUrl, "lo"), parameters());
  publisher.publish(sample_information(8), {});
  REQUIRE(subscriber.next_frame(10s) != nullptr);
  CHECK_THROWS_WITH_AS(open_sender(kUrl, "nosuch0"), "there is no network interface nosuch0",
                       LcmUnavailable);
  CHECK_THROWS_AS(open_receiver(kUrl, {"A"}, "nosuch0"), LcmUnavailable);
}

TEST_CASE("a hostile sender in the group keeps no frame from a subscriber") {
  if (!multicast_is_private()) return;
  Subscriber subscriber(kUrl, "UDP_TEST");
  Publisher publisher(open_sender(kUrl), parameters());
  const RawSender hostile;
  const std::vector<Datagram> good = good_datagrams();
  std::mt19937 random(1);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random()) % n; };
  // What crashes LCM's own receiver: the place of the second fragment wraps around.
  const std::vector<Datagram> crafted = {
      fragment(200, 0, 0, 2, std::string_view("UDP_TEST_FRAME\0xxxxxxxxxxxx", 27)),
      fragment(200, 0xfffffff0, 1, 2, std::string(64, 'y')), fragment(0, 0, 0, 0, ""),
      fragment(0xffffffff, 0, 0, 65535, "UDP_TEST_FRAME")};
  for (std::int64_t number = 0; number < 300; ++number) {
    for (int i = 0; i < 20; ++i) {
      Datagram datagram = good[below(good.size())];
      for (std::size_t k = 0; k < 1 + below(8); ++k) {
        // Behind the header mostly, where the lengths are; a session of its own, so that it does
        // not pass for the publisher.
        datagram[below(datagram.size())] = static_cast<std::uint8_t>(random());
      }
      if (below(3) == 0) datagram.resize(below(datagram.size()));
      hostile.send(datagram);
    }
    hostile.send(crafted[below(crafted.size())]);
    FrameInformation information = sample_information(number);
    information.session = 424242;
    publisher.publish(information, sample_markers(static_cast<int>(below(40))));
    // Frames that the hostile sender's messages make may come too.
    const ReceivedFrame* frame = nullptr;
    do {
      frame = subscriber.next_frame(10s);
      REQUIRE(frame != nullptr);
    } while (frame->header.session != 424242);
    REQUIRE(frame->header.frame == number);
  }
  CHECK(subscriber.counts().garbage > 1000);
}

TEST_CASE("nonsense without end does not keep a subscriber from its caller") {
  if (!multicast_is_private()) return;
  Subscriber subscriber(kUrl, "UDP_TEST");
  const RawSender hostile;
  for (int i = 0; i < 3000; ++i) hostile.send({'L', 'C', '0', '9'});
  CHECK(subscriber.next_frame(0ms) == nullptr);
}

namespace {

// How many of ten messages with that TTL leave by an interface, seen at the other end of its cable;
// -1: namespaces or interfaces can't be made here. For a child, which leaves this network.
int messages_that_leave(int ttl) {
  if (::unshare(CLONE_NEWNET) != 0 && ::unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) return -1;
  if (std::system("ip link add v0 type veth peer name v1 && ip link set lo up && "
                  "ip address add 10.9.0.1/24 dev v0 && ip link set v0 up && ip link set v1 up") !=
      0) {
    return -1;
  }
  const int other_end = ::socket(AF_PACKET, SOCK_DGRAM | SOCK_CLOEXEC, htons(ETH_P_IP));
  sockaddr_ll address{};
  address.sll_family = AF_PACKET;
  address.sll_protocol = htons(ETH_P_IP);
  address.sll_ifindex = static_cast<int>(::if_nametoindex("v1"));
  ::bind(other_end, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  const auto sender = open_sender(
      "udpm://239.255.76.69:" + std::to_string(kPort) + "?ttl=" + std::to_string(ttl), "v0");
  const Datagram message(10, 'x');
  for (int i = 0; i < 10; ++i) sender->send("A", message);
  int seen = 0;
  for (pollfd descriptor = {other_end, POLLIN, 0}; ::poll(&descriptor, 1, 300) > 0;) {
    Datagram packet(2000);
    const ssize_t size = ::recv(other_end, packet.data(), packet.size(), 0);
    constexpr std::size_t kProtocolByte = 9;
    if (size > 20 && packet[kProtocolByte] == IPPROTO_UDP) ++seen;
  }
  return seen;
}

int in_a_child(int ttl) {
  const pid_t child = ::fork();
  if (child == 0) {
    int seen = -1;
    try {
      seen = messages_that_leave(ttl);
    } catch (const std::exception& e) {
      std::cerr << e.what() << '\n';
      seen = 99;
    }
    ::_exit(seen < 0 ? 255 : seen);
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  REQUIRE(WIFEXITED(status));
  return WEXITSTATUS(status);
}

}  // namespace

TEST_CASE("messages with ttl=0 do not leave the machine, those with ttl=1 do") {
  const int far = in_a_child(1);
  if (far == 255) {
    MESSAGE("skipped: network namespaces are not allowed here");
    return;
  }
  CHECK(far == 10);
  CHECK(in_a_child(0) == 0);
}
