#include "daemon/control/recording_queue.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <thread>

#include "tests/allocation_counter.hpp"

using namespace roundel;

namespace {

// Fills the place for a frame whose every pixel is its number.
bool offer(RecordingQueue& queue, std::int64_t number) {
  RecordingQueue::Entry* const entry = queue.back();
  if (entry == nullptr) return false;
  entry->frame.information.frame = number;
  entry->frame.picture.resize(64, 48);
  std::fill(entry->frame.picture.pixels.begin(), entry->frame.picture.pixels.end(),
            static_cast<std::uint8_t>(number));
  queue.push();
  return true;
}

bool is_whole(const RecordingQueue::Entry& entry) {
  const auto grey = static_cast<std::uint8_t>(entry.frame.information.frame);
  return std::all_of(entry.frame.picture.pixels.begin(), entry.frame.picture.pixels.end(),
                     [&](std::uint8_t pixel) { return pixel == grey; });
}

}  // namespace

TEST_CASE("what a reader is too slow for is left out and counted") {
  RecordingQueue queue(64, 48);
  const auto room = static_cast<std::int64_t>(queue.capacity());
  CHECK(queue.front() == nullptr);
  for (std::int64_t i = 0; i < room; ++i) CHECK(offer(queue, i));
  CHECK_FALSE(offer(queue, room));
  CHECK_FALSE(offer(queue, room + 1));
  CHECK(queue.front()->frame.information.frame == 0);
  CHECK(queue.front()->unrecorded == 0);
  queue.pop();
  CHECK(offer(queue, room + 2));
  for (std::int64_t i = 1; i < room; ++i) {
    CHECK(queue.front()->frame.information.frame == i);
    queue.pop();
  }
  CHECK(queue.front()->frame.information.frame == room + 2);
  CHECK(queue.front()->unrecorded == 2);
}

TEST_CASE("frames of any size find some room, of usual sizes without allocating") {
  CHECK(RecordingQueue(8000, 6000).capacity() == 4);
  RecordingQueue queue(64, 48);
  const AllocationCounter counter;
  for (int i = 0; i < 1000; ++i) {
    offer(queue, i);
    queue.pop();
  }
  CHECK(counter.count() == 0);
}

TEST_CASE("frames go from one thread to another whole and in order") {
  constexpr std::int64_t kFrames = 20'000;
  RecordingQueue queue(64, 48);
  std::int64_t offered = 0;
  std::thread writer([&] {
    for (std::int64_t i = 0; i < kFrames; ++i) offered += offer(queue, i) ? 1 : 0;
    queue.close();
  });
  std::int64_t taken = 0, last = -1;
  bool good = true;
  for (;;) {
    const bool ended = queue.closed();
    const RecordingQueue::Entry* const entry = queue.front();
    if (entry == nullptr) {
      if (ended) break;
      continue;
    }
    good = good && is_whole(*entry) && entry->frame.information.frame > last;
    last = entry->frame.information.frame;
    ++taken;
    queue.pop();
  }
  writer.join();
  CHECK(good);
  CHECK(queue.front() == nullptr);
  CHECK(taken == offered);
}
