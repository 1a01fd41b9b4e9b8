#include "transport/route.hpp"

#include <doctest/doctest.h>

#include <cerrno>

#include "tests/private_network.hpp"

using namespace roundel;

TEST_CASE("the way of multicast is told with its interface, as the routes are") {
  if (!multicast_is_private()) return;
  const Route route = find_route("239.255.76.67", 7667);
  CHECK(route.error == 0);
  CHECK(route.interface == "lo");
  CHECK(route.address.empty());
  CHECK(find_route("127.0.0.1", 7667).address == "127.0.0.1");
}

TEST_CASE("where no route leads there is none") {
  if (!multicast_is_private()) return;
  CHECK(find_route("192.0.2.1", 7667).error == ENETUNREACH);
  CHECK(find_route("not an address", 7667).error == EINVAL);
}
