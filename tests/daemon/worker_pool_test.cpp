#include "daemon/worker_pool.hpp"

#include <doctest/doctest.h>

#include <array>
#include <atomic>
#include <memory>

#include "core/tracker.hpp"
#include "simulator/arena.hpp"

using namespace roundel;

TEST_CASE("every run calls the task once for every worker and returns when all are done") {
  constexpr int kRuns = 2000;
  for (const int count : {1, 2, 5}) {
    CAPTURE(count);
    WorkerPool pool(count);
    REQUIRE(pool.count() == count);
    std::array<int, 5> calls{};  // each touched by its worker alone, and read after the run
    for (int run = 1; run <= kRuns; ++run) {
      pool.run(
          [](void* context, int worker) {
            ++(*static_cast<std::array<int, 5>*>(context))[static_cast<std::size_t>(worker)];
          },
          &calls);
      for (int worker = 0; worker < 5; ++worker) {
        REQUIRE(calls[static_cast<std::size_t>(worker)] == (worker < count ? run : 0));
      }
    }
  }
}

TEST_CASE("many markers are tracked to the bit as by one thread when workers share them") {
  ArenaOptions options;
  options.robots = 20;
  Arena arena(options);
  DetectorParameters parameters;
  parameters.bits = options.bits;
  Tracker alone(parameters, arena.camera()), shared(parameters, arena.camera());
  const auto pool = std::make_shared<WorkerPool>(3);
  shared.share_work(pool);
  GreyImage image;
  std::size_t compared = 0;
  for (int frame = 0; frame < 12; ++frame) {
    arena.render(frame, image);
    const auto expected = alone.track(image.view());
    const auto found = shared.track(image.view());
    REQUIRE(found.size() == expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      CHECK(found[i].track == expected[i].track);
      CHECK(found[i].id == expected[i].id);
      CHECK(found[i].pose.position == expected[i].pose.position);
      CHECK(found[i].pose.orientation.coeffs() == expected[i].pose.orientation.coeffs());
      CHECK(found[i].sigma_position == expected[i].sigma_position);
      ++compared;
    }
  }
  CHECK(compared > 200);
}
