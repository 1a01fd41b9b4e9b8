#include "transport/publisher.hpp"

#include <doctest/doctest.h>

#include <map>
#include <string>
#include <utility>

#include "tests/sample_markers.hpp"
#include "transport/subscriber.hpp"

using namespace roundel;
using namespace std::chrono_literals;

namespace {

PublisherParameters parameters(bool per_marker = false) {
  PublisherParameters parameters;
  parameters.channel = "TEST";
  parameters.camera = "ceiling";
  parameters.per_marker = per_marker;
  return parameters;
}

// Counts the messages on a link from now on, by channel.
class Recorder {
 public:
  explicit Recorder(LcmLink link) : link_(std::move(link)) {
    subscription_ = ::lcm_subscribe(
        link_.get(), ".*",
        [](const lcm_recv_buf_t*, const char* channel, void* user) {
          ++(*static_cast<std::map<std::string, int>*>(user))[channel];
        },
        &counts_);
  }
  ~Recorder() { ::lcm_unsubscribe(link_.get(), subscription_); }
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  std::map<std::string, int> counts() {
    while (::lcm_handle_timeout(link_.get(), 0) > 0) {
    }
    return std::exchange(counts_, {});
  }

 private:
  LcmLink link_;
  lcm_subscription_t* subscription_ = nullptr;
  std::map<std::string, int> counts_;
};

}  // namespace

TEST_CASE("published frames arrive whole, with both publish times") {
  const LcmLink link = open_lcm("memq://", LcmUse::kSend);
  Publisher publisher(link, parameters());
  Subscriber subscriber(link, "TEST");
  for (const int count : {0, 1, 100}) {
    const auto markers = sample_markers(count);
    const TimeStamp before = now();
    const TimeStamp published = publisher.publish(sample_information(count), markers);
    const TimeStamp after = now();
    CHECK(published.mono_us >= before.mono_us);
    CHECK(published.mono_us <= after.mono_us);
    const ReceivedFrame* frame = subscriber.next_frame(1s);
    REQUIRE(frame != nullptr);
    CHECK(frame->header.frame == count);
    CHECK(frame->header.publish_mono == published.mono_us);
    CHECK(frame->header.publish_utime == published.wall_us);
    CHECK(frame->camera == "ceiling");
    CHECK(frame->markers.size() == markers.size());
  }
  CHECK(publisher.unsent_frames() == 0);
  CHECK(publisher.sending());
  CHECK(subscriber.next_frame(0ms) == nullptr);
}

TEST_CASE("status messages arrive beside the frames") {
  const LcmLink link = open_lcm("memq://", LcmUse::kSend);
  Publisher publisher(link, parameters());
  Subscriber subscriber(link, "TEST");
  status_t status{};
  status.frames = 17;
  status.version = "0.1.0";
  publisher.publish(status);
  status.version = "a longer version";
  publisher.publish(status);
  publisher.publish(sample_information(), {});
  REQUIRE(subscriber.next_frame(1s) != nullptr);
  REQUIRE(subscriber.status().has_value());
  CHECK(subscriber.status()->frames == 17);
  CHECK(subscriber.status()->version == "a longer version");
}

TEST_CASE("single poses go out on their own channels if they are asked for") {
  const LcmLink link = open_lcm("memq://", LcmUse::kSend);
  Recorder recorder(link);
  auto markers = sample_markers(2);
  markers.push_back(Marker{});
  Publisher(link, parameters(false)).publish(sample_information(), markers);
  CHECK(recorder.counts() == std::map<std::string, int>{{"TEST_FRAME", 1}});
  Publisher(link, parameters(true)).publish(sample_information(), markers);
  CHECK(recorder.counts() ==
        std::map<std::string, int>{{"TEST_FRAME", 1}, {"TEST_POSE_1", 1}, {"TEST_POSE_2", 1}});
}

TEST_CASE("something else on the channel does not disturb a subscriber") {
  const LcmLink link = open_lcm("memq://", LcmUse::kSend);
  Publisher publisher(link, parameters());
  Subscriber subscriber(link, "TEST");
  ::lcm_publish(link.get(), "TEST_FRAME", "hello", 5);
  ::lcm_publish(link.get(), "TEST_STATUS", "hello", 5);
  ::lcm_publish(link.get(), "TEST_FRAME", "", 0);
  publisher.publish(sample_information(3), sample_markers(2));
  const ReceivedFrame* frame = subscriber.next_frame(1s);
  REQUIRE(frame != nullptr);
  CHECK(frame->header.frame == 3);
  CHECK(subscriber.counts().garbage == 2);
  CHECK_FALSE(subscriber.status().has_value());
}

TEST_CASE("a channel prefix with characters of a pattern is refused") {
  const LcmLink link = open_lcm("memq://", LcmUse::kReceive);
  CHECK_THROWS_AS(Subscriber(link, ".*"), std::invalid_argument);
  CHECK_THROWS_AS(Subscriber(link, ""), std::invalid_argument);
  CHECK_THROWS_AS(Subscriber(link, std::string(60, 'A')), std::invalid_argument);
}
