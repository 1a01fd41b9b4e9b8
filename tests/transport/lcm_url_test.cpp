#include "transport/lcm_url.hpp"

#include <doctest/doctest.h>

#include <string>

#include "tests/error_of.hpp"
#include "tests/temporary_directory.hpp"
#include "transport/lcm_link.hpp"
#include "transport/message_receiver.hpp"

using namespace roundel;

namespace {

std::string error_for(const std::string& url) {
  return error_of([&] { parse_lcm_url(url); });
}

}  // namespace

TEST_CASE("LCM URLs are taken apart") {
  const LcmUrl url = parse_lcm_url("udpm://239.1.2.3:4000?ttl=1&recv_buf_size=2000000");
  CHECK(url.provider == LcmUrl::Provider::kUdp);
  CHECK(url.address == "239.1.2.3");
  CHECK(url.port == 4000);
  CHECK(url.ttl == 1);
  CHECK(parse_lcm_url("udpm://").address == "239.255.76.67");
  CHECK(parse_lcm_url("udpm://").port == 7667);
  CHECK(parse_lcm_url("udpm://239.255.76.67").ttl == 0);
  CHECK(parse_lcm_url("memq://").provider == LcmUrl::Provider::kMemory);
  CHECK(parse_lcm_url("file:///tmp/a.lcm?mode=w").writing);
  CHECK_FALSE(parse_lcm_url("file:///tmp/a.lcm").writing);
}

TEST_CASE("a machine's address is for sending") {
  CHECK(parse_lcm_url("udpm://10.0.0.1:7667").address == "10.0.0.1");
  CHECK_FALSE(parse_lcm_url("udpm://10.0.0.1:7667").is_multicast());
  CHECK(parse_lcm_url("udpm://").is_multicast());
  CHECK_FALSE(parse_lcm_url("memq://").is_multicast());
  CHECK_THROWS_WITH_AS(
      open_receiver("udpm://10.0.0.1:7700", {"A"}),
      "\"udpm://10.0.0.1:7700\" is for sending to one machine; that machine listens "
      "at any multicast URL with the same port, as in udpm://239.255.76.67:7700",
      LcmUrlError);
}

TEST_CASE("an LCM URL that can't work is refused with the reason and what would work") {
  CHECK(error_for("udp://239.255.76.67:7667") ==
        "\"udp://239.255.76.67:7667\" is no usable LCM URL: unknown kind; accepted: "
        "udpm://ADDRESS:PORT?ttl=N with a multicast address (224.0.0.0 to 239.255.255.255), "
        "udpm://ADDRESS:PORT with a machine's address, memq://, file://PATH?mode=w");
  CHECK(error_for("").find("unknown kind") != std::string::npos);
  CHECK(error_for("udpm://239.255.76").find("is not an IPv4 address") != std::string::npos);
  CHECK(error_for("udpm://0.0.0.0:7667").find("0.0.0.0 is nobody's address") != std::string::npos);
  CHECK(error_for("udpm://239.255.76.67:0").find("is not a port") != std::string::npos);
  CHECK(error_for("udpm://239.255.76.67:99999").find("is not a port") != std::string::npos);
  CHECK(error_for("udpm://239.255.76.67:7667?ttl=x").find("ttl must be 0 to 255") !=
        std::string::npos);
  CHECK(error_for("udpm://239.255.76.67:7667?tll=1").find("unknown option \"tll\"") !=
        std::string::npos);
  CHECK(error_for("file://").find("no path") != std::string::npos);
}

TEST_CASE("a log file is opened for the use it was named for, or not at all") {
  CHECK_THROWS_WITH_AS(open_lcm("file:///tmp/a.lcm", LcmUse::kSend), doctest::Contains("?mode=w"),
                       LcmUrlError);
  CHECK_THROWS_AS(open_lcm("file:///tmp/a.lcm?mode=w", LcmUse::kReceive), LcmUrlError);
}
