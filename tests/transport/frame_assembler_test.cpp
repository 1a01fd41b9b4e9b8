#include "transport/frame_assembler.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>

#include "tests/sample_markers.hpp"

using namespace roundel;

namespace {

std::vector<Message> encoded(const FrameInformation& information, int markers,
                             int max_datagram = 1400) {
  FrameEncoder encoder("ROUNDEL_FRAME", "ceiling", max_datagram);
  return copied(encoder.encode(information, sample_markers(markers)));
}

std::vector<Message> encoded(std::int64_t frame, int markers) {
  return encoded(sample_information(frame), markers);
}

void check_is_whole(const ReceivedFrame* frame, std::int64_t number, int markers) {
  REQUIRE(frame != nullptr);
  CHECK(frame->header.frame == number);
  CHECK(frame->camera == "ceiling");
  REQUIRE(frame->markers.size() == static_cast<std::size_t>(markers));
  for (int i = 0; i < markers; ++i) {
    REQUIRE(frame->markers[static_cast<std::size_t>(i)].id == sample_marker(i).id);
  }
}

}  // namespace

TEST_CASE("a frame of 100 markers is put together from its parts") {
  FrameAssembler assembler;
  const auto parts = encoded(7, 100);
  REQUIRE(parts.size() == 15);
  for (std::size_t i = 0; i + 1 < parts.size(); ++i) REQUIRE(assembler.take(parts[i]) == nullptr);
  check_is_whole(assembler.take(parts.back()), 7, 100);
  CHECK(assembler.counts().frames == 1);
  CHECK(assembler.counts().lost == 0);
}

TEST_CASE("parts may come in any order, twice, and mixed with those of other frames") {
  std::mt19937 random(3);
  FrameAssembler assembler;
  for (std::int64_t frame = 0; frame < 40; frame += 2) {
    auto messages = encoded(frame, 30);
    const auto copies = messages;
    messages.insert(messages.end(), copies.begin(), copies.end());
    std::shuffle(messages.begin(), messages.end(), random);
    const auto other = encoded(frame + 1, 9);
    messages.insert(messages.begin() + 2, other[1]);
    int whole = 0;
    for (const Message& message : messages) {
      const ReceivedFrame* received = assembler.take(message);
      if (received == nullptr) continue;
      check_is_whole(received, frame, 30);
      ++whole;
    }
    CHECK(whole == 1);
    check_is_whole(assembler.take(other[0]), frame + 1, 9);
  }
  CHECK(assembler.counts().frames == 40);
  CHECK(assembler.counts().lost == 0);
  CHECK(assembler.counts().garbage == 0);
}

TEST_CASE("empty frames are frames") {
  FrameAssembler assembler;
  check_is_whole(assembler.take(encoded(0, 0)[0]), 0, 0);
  check_is_whole(assembler.take(encoded(1, 0)[0]), 1, 0);
}

TEST_CASE("frames that do not arrive whole are counted as lost") {
  FrameAssembler assembler;
  assembler.take(encoded(10, 1)[0]);
  const auto incomplete = encoded(11, 20);
  assembler.take(incomplete[0]);
  assembler.take(incomplete[2]);
  check_is_whole(assembler.take(encoded(15, 1)[0]), 15, 1);
  CHECK(assembler.counts().frames == 2);
  CHECK(assembler.counts().lost == 4);
  // A straggler is not delivered after a newer frame.
  CHECK(assembler.take(incomplete[1]) == nullptr);
  CHECK(assembler.counts().frames == 2);
}

TEST_CASE("frames that the daemon dropped are not counted as lost") {
  FrameAssembler assembler;
  assembler.take(encoded(10, 1)[0]);
  FrameInformation later = sample_information(20);
  later.dropped = 7;
  check_is_whole(assembler.take(encoded(later, 1)[0]), 20, 1);
  CHECK(assembler.counts().lost == 2);
}

TEST_CASE("a new session starts its numbers anew without losses") {
  FrameAssembler assembler;
  assembler.take(encoded(1000, 1)[0]);
  FrameInformation restarted = sample_information(0);
  restarted.session += 1;
  check_is_whole(assembler.take(encoded(restarted, 1)[0]), 0, 1);
  CHECK(assembler.counts().lost == 0);
  CHECK(assembler.counts().frames == 2);
}

TEST_CASE("two senders on one channel do not disturb each other") {
  FrameAssembler assembler;
  for (std::int64_t frame = 0; frame < 10; ++frame) {
    for (const int sender : {0, 1}) {
      FrameInformation information = sample_information(frame + 100 * sender);
      information.session += sender;
      check_is_whole(assembler.take(encoded(information, 3)[0]), frame + 100 * sender, 3);
    }
  }
  CHECK(assembler.counts().lost == 0);
}

TEST_CASE("parts that contradict each other do not make a frame") {
  FrameAssembler assembler;
  const auto twenty = encoded(1, 20), thirty = encoded(1, 30);
  CHECK(assembler.take(twenty[0]) == nullptr);
  CHECK(assembler.take(thirty[1]) == nullptr);
  CHECK(assembler.counts().garbage == 1);
  CHECK(assembler.take(twenty[1]) == nullptr);
  check_is_whole(assembler.take(twenty[2]), 1, 20);
}

TEST_CASE("garbage is counted and otherwise ignored") {
  FrameAssembler assembler;
  std::mt19937 random(9);
  const auto parts = encoded(5, 20);
  for (int i = 0; i < 20000; ++i) {
    Message message = parts[random() % parts.size()];
    // Behind the type's fingerprint, so that the damage gets to the decoder and the assembler.
    for (unsigned change = 0; change <= random() % 6; ++change) {
      const std::size_t at = 8 + random() % (message.size() - 8);
      message[at] = static_cast<std::uint8_t>(random() % 3 == 0 ? 0xff : random());
    }
    if (random() % 4 == 0) message.resize(random() % message.size());
    const ReceivedFrame* received = assembler.take(message);
    if (received != nullptr) REQUIRE(received->markers.size() <= 20000);
  }
  CHECK(assembler.counts().garbage > 1000);
  FrameInformation fresh = sample_information(6);
  fresh.session = 1;
  check_is_whole(assembler.take(encoded(fresh, 1)[0]), 6, 1);
}
