#include <doctest/doctest.h>

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <sched.h>

#include "tests/private_network.hpp"
#include "tests/sample_markers.hpp"
#include "transport/publisher.hpp"
#include "transport/subscriber.hpp"

using namespace roundel;
using namespace std::chrono_literals;

namespace {

constexpr const char* kUrl = "udpm://239.255.76.68:7670?ttl=0";

}  // namespace

TEST_CASE("100 markers go over real multicast in parts and arrive as one frame") {
  if (!multicast_is_private()) return;
  Subscriber subscriber(kUrl, "MULTICAST_TEST");
  PublisherParameters parameters;
  parameters.channel = "MULTICAST_TEST";
  parameters.camera = "ceiling";
  Publisher publisher(open_sender(kUrl), parameters);
  for (std::int64_t number = 0; number < 20; ++number) {
    const auto markers = sample_markers(number % 2 == 0 ? 100 : 0);
    publisher.publish(sample_information(number), markers);
    const ReceivedFrame* frame = subscriber.next_frame(10s);
    REQUIRE(frame != nullptr);
    CHECK(frame->header.frame == number);
    REQUIRE(frame->markers.size() == markers.size());
    for (std::size_t i = 0; i < markers.size(); ++i) {
      REQUIRE(frame->markers[i].track == markers[i].track);
    }
    CHECK(subscriber.received_utime() >= frame->header.publish_utime);
  }
  CHECK(subscriber.counts().lost == 0);
  CHECK(subscriber.counts().garbage == 0);
}

TEST_CASE("a packet without a message is garbage, whatever was received before it") {
  if (!multicast_is_private()) return;
  Subscriber subscriber(open_lcm(kUrl, LcmUse::kReceive), "CUT_TEST");
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in group{};
  group.sin_family = AF_INET;
  group.sin_port = htons(7670);
  group.sin_addr.s_addr = htonl(0xEFFF4C44);  // 239.255.76.68
  // liblcm 1.3 reads the second, which is nothing but the head of a packet, into what it keeps of
  // the first, takes the name from there, and passes on a message of a negative size.
  for (const std::string channel : {"CUT_TEST_STATUS", "CUT_TEST_FRAME"}) {
    const std::string number(4, '\0'), rest(600, '_');
    for (const std::string& packet : {"none" + number + channel + '\0' + rest, "LC02" + number}) {
      REQUIRE(::sendto(socket, packet.data(), packet.size(), 0,
                       reinterpret_cast<const sockaddr*>(&group), sizeof group) > 0);
    }
    // Before another one comes into the same place.
    pollfd descriptor = {subscriber.descriptor(), POLLIN, 0};
    REQUIRE(::poll(&descriptor, 1, 10'000) == 1);
    CHECK(subscriber.next_frame(0s) == nullptr);
  }
  ::close(socket);
  // What is sent properly behind them arrives.
  PublisherParameters parameters;
  parameters.channel = "CUT_TEST";
  Publisher publisher(open_lcm(kUrl, LcmUse::kSend), parameters);
  publisher.publish(sample_information(1), sample_markers(1));
  CHECK(subscriber.next_frame(10s) != nullptr);
  CHECK(subscriber.counts().garbage == 1);
  CHECK_FALSE(subscriber.status().has_value());
}

TEST_CASE("without a route to the multicast group the error says so") {
  // In a child, because it leaves this network for one that has nothing.
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  constexpr int kRight = 0, kWrong = 1, kNoNamespace = 2;
  if (child == 0) {
    if (::unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0 && ::unshare(CLONE_NEWNET) != 0) {
      ::_exit(kNoNamespace);
    }
    try {
      open_sender(kUrl);
    } catch (const LcmUnavailable& error) {
      const std::string text = error.what();
      ::_exit(text.find("no route to the multicast group 239.255.76.68") == 0 ? kRight : kWrong);
    }
    ::_exit(kWrong);
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  REQUIRE(WIFEXITED(status));
  if (WEXITSTATUS(status) == kNoNamespace) {
    MESSAGE("skipped: network namespaces are not allowed here");
    return;
  }
  CHECK(WEXITSTATUS(status) == kRight);
}
