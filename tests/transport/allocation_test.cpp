#include <doctest/doctest.h>

#include <memory>

#include "tests/allocation_counter.hpp"
#include "tests/private_network.hpp"
#include "tests/sample_markers.hpp"
#include "transport/publisher.hpp"

using namespace roundel;

TEST_CASE("the allocation counter sees an allocation") {
  const AllocationCounter counter;
  const auto value = std::make_unique<int>(1);
  CHECK(counter.count() == 1);
  CHECK(*value == 1);
}

TEST_CASE("encoding a frame allocates nothing after warm-up") {
  FrameEncoder frames("ROUNDEL_FRAME", "a camera with a long name", 1400);
  PoseEncoder poses("ROUNDEL");
  const auto most = sample_markers(100);
  frames.encode(sample_information(), most);
  for (const Marker* marker : poses.select(most)) poses.encode(sample_information(), *marker);
  for (const std::size_t count : {1U, 12U, 100U, 0U, 100U}) {
    CAPTURE(count);
    const auto markers = std::span(most).first(count);
    std::size_t bytes = 0;
    long allocations = 0;
    {
      const AllocationCounter counter;
      for (const Bytes part : frames.encode(sample_information(), markers)) bytes += part.size();
      for (const Marker* marker : poses.select(markers)) {
        bytes += poses.encode(sample_information(), *marker).size();
      }
      allocations = counter.count();
    }
    CHECK(allocations == 0);
    CHECK(bytes > 100 * count);
  }
}

TEST_CASE("publishing over UDP allocates nothing after warm-up") {
  if (!multicast_is_private()) return;
  PublisherParameters parameters;
  parameters.camera = "a camera with a long name";
  parameters.per_marker = true;
  Publisher publisher(open_sender("udpm://239.255.76.67:7667?ttl=0"), parameters);
  status_t status{};
  status.source = "a simulator with a long description";
  const auto most = sample_markers(100);
  publisher.publish(sample_information(), most);
  publisher.publish(status);
  for (const std::size_t count : {1U, 12U, 100U, 0U, 100U}) {
    CAPTURE(count);
    long allocations = 0;
    {
      const AllocationCounter counter;
      publisher.publish(sample_information(), std::span(most).first(count));
      publisher.publish(status);
      allocations = counter.count();
    }
    CHECK(allocations == 0);
  }
  CHECK(publisher.unsent_frames() == 0);
}
