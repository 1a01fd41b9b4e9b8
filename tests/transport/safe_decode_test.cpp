#include "transport/safe_decode.hpp"

#include <doctest/doctest.h>

#include <cstring>
#include <random>

#include "tests/sample_markers.hpp"
#include "transport/pose_encoder.hpp"

using namespace roundel;

namespace {

Message encoded_frame(int markers) {
  FrameEncoder encoder("ROUNDEL_FRAME", "ceiling", 9000);
  return copied(encoder.encode(sample_information(), sample_markers(markers))).at(0);
}

Message encoded_status() {
  status_t status{};
  status.frames = 5;
  status.camera = "ceiling";
  status.source = "simulator";
  status.url = "memq://";
  status.version = "0.1.0";
  Message message(static_cast<std::size_t>(status.getEncodedSize()));
  REQUIRE(status.encode(message.data(), 0, static_cast<int>(message.size())) ==
          static_cast<int>(message.size()));
  return message;
}

void write_length(Message& message, std::size_t at, std::int32_t length) {
  for (std::size_t i = 0; i < 4; ++i) {
    message[at + i] = static_cast<std::uint8_t>(static_cast<std::uint32_t>(length) >> (24 - 8 * i));
  }
}

std::size_t position_of(const Message& message, const char* text) {
  const auto found = std::search(message.begin(), message.end(), text, text + std::strlen(text));
  REQUIRE(found != message.end());
  return static_cast<std::size_t>(found - message.begin());
}

constexpr std::int32_t kWrongLengths[] = {-2147483647 - 1, -1, 0, 1, 6, 9, 1000, 2147483647};

}  // namespace

TEST_CASE("whole messages are decoded") {
  frame_t frame;
  CHECK(decode(encoded_frame(3), frame));
  CHECK(frame.markers.size() == 3);
  CHECK(frame.camera == "ceiling");
  status_t status;
  CHECK(decode(encoded_status(), status));
  CHECK(status.frames == 5);
  CHECK(status.version == "0.1.0");
}

TEST_CASE("a wrong number of markers is refused before anything is allocated for it") {
  for (const std::int32_t length : kWrongLengths) {
    CAPTURE(length);
    Message message = encoded_frame(3);
    write_length(message, position_of(message, "ceiling") - 8, length);
    frame_t frame;
    CHECK_FALSE(decode(message, frame));
  }
}

TEST_CASE("a wrong length of a text is refused") {
  for (const std::int32_t length : kWrongLengths) {
    CAPTURE(length);
    frame_t frame;
    Message message = encoded_frame(3);
    write_length(message, position_of(message, "ceiling") - 4, length);
    CHECK_FALSE(decode(message, frame));
    for (const char* text : {"ceiling", "simulator", "memq://", "0.1.0"}) {
      if (length == static_cast<std::int32_t>(std::strlen(text)) + 1) continue;  // right
      CAPTURE(text);
      Message status_message = encoded_status();
      write_length(status_message, position_of(status_message, text) - 4, length);
      status_t status;
      CHECK_FALSE(decode(status_message, status));
    }
  }
}

TEST_CASE("a message cut short anywhere, or with something behind it, is refused") {
  frame_t frame;
  pose_t pose;
  status_t status;
  const Message frame_message = encoded_frame(2), status_message = encoded_status();
  for (std::size_t size = 0; size < frame_message.size(); ++size) {
    REQUIRE_FALSE(decode(Bytes(frame_message).first(size), frame));
  }
  for (std::size_t size = 0; size < status_message.size(); ++size) {
    REQUIRE_FALSE(decode(Bytes(status_message).first(size), status));
  }
  Message longer = frame_message;
  longer.push_back(0);
  CHECK_FALSE(decode(longer, frame));
  CHECK_FALSE(decode(Bytes(), pose));
}

TEST_CASE("a message of another type is refused") {
  frame_t frame;
  pose_t pose;
  status_t status;
  CHECK_FALSE(decode(encoded_status(), frame));
  CHECK_FALSE(decode(encoded_status(), pose));
  CHECK_FALSE(decode(encoded_frame(1), status));
  CHECK_FALSE(decode(encoded_frame(1), pose));
}

TEST_CASE("random bytes never do harm") {
  std::mt19937 random(1);
  frame_t frame;
  status_t status;
  pose_t pose;
  for (int i = 0; i < 20000; ++i) {
    Message message = i % 2 == 0 ? encoded_frame(i % 5) : encoded_status();
    const std::size_t from = i % 3 == 0 ? 0 : 8;  // mostly leave the fingerprint alone
    for (int change = 0; change < 5; ++change) {
      message[from + random() % (message.size() - from)] = static_cast<std::uint8_t>(random());
    }
    if (i % 7 == 0) message.resize(random() % message.size());
    if (decode(message, frame)) REQUIRE(frame.markers.size() < 5);
    if (decode(message, status)) REQUIRE(status.url.size() < message.size());
    decode(message, pose);
  }
}
