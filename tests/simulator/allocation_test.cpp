#include "tests/allocation_counter.hpp"

#include <doctest/doctest.h>

#include "simulator/arena.hpp"

using namespace roundel;

TEST_CASE("rendering frame after frame allocates nothing once it is warm") {
  ArenaOptions options;
  options.image_width = 640;
  options.image_height = 360;
  options.occluder = true;
  Arena arena(options);
  GreyImage image;
  std::int64_t frame = 0;
  {
    const AllocationCounter counter;
    for (; frame < 10; ++frame) arena.render(frame, image);
    CHECK(counter.count() > 0);  // the counter counts
  }
  const AllocationCounter counter;
  for (; frame < 80; ++frame) {
    arena.render(frame, image);
    arena.truth(frame);
  }
  CHECK(counter.count() == 0);
}
