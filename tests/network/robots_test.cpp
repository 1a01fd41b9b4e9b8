// An arena's network: roundeld on one machine, robots on others, multicast with TTL 1 between them.
#include <doctest/doctest.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstring>
#include <sstream>

#include "calibration/camera_file.hpp"
#include "daemon/y4m.hpp"
#include "simulator/arena.hpp"
#include "tests/network/hosts.hpp"
#include "tests/private_network.hpp"
#include "tests/random.hpp"
#include "tests/temporary_directory.hpp"
#include "transport/clock.hpp"
#include "transport/subscriber.hpp"

using namespace roundel;
using namespace std::chrono_literals;

namespace {

constexpr int kDaemon = 0, kFirstRobot = 1, kSecondRobot = 2, kHostile = 3;
constexpr int kRobots = 100;
constexpr double kFrameRate = 60;
const std::string kUrl = "udpm://239.255.76.67:7667?ttl=1";

// A recording of a hundred robots, and its lens.
struct Recording {
  explicit Recording(const TemporaryDirectory& folder)
      : video(folder.file("arena.y4m")), lens(folder.file("lens.yaml")) {
    ArenaOptions options;
    options.robots = kRobots;
    options.bits = 11;
    options.image_width = 1280;
    options.image_height = 720;
    options.length_m = 5;
    options.width_m = 3;
    options.camera_height_m = 4;
    options.clutter = false;
    options.corners = false;
    Arena arena(options);
    Y4mWriter writer(video, options.image_width, options.image_height, kFrameRate);
    GreyImage image;
    for (int frame = 0; frame < 8; ++frame) {
      arena.render(frame, image);
      writer.write(image.view());
    }
    writer.close();
    write_camera_file(lens, {"arena", arena.camera()});
  }
  std::string video, lens;
};

std::vector<std::string> roundeld(const Recording& recording) {
  std::vector<std::string> command = {ROUNDELD_BINARY};
  const std::vector<std::string> settings = {"source=files",
                                             "files.loop=true",
                                             "marker.bits=11",
                                             "control.socket=",
                                             "lcm.url=" + kUrl,
                                             "files.paths=[" + recording.video + "]",
                                             "camera.calibration=" + recording.lens,
                                             fmt::format("files.frame_rate={}", kFrameRate)};
  for (const std::string& setting : settings) command.insert(command.end(), {"--set", setting});
  return command;
}

// Packets that came to the machine of this thread, and for which a program there was too slow.
std::int64_t packets_left_unread() {
  std::istringstream lines(read_file("/proc/thread-self/net/snmp"));
  std::vector<std::string> names;
  for (std::string line, word; std::getline(lines, line);) {
    if (!line.starts_with("Udp:")) continue;
    std::istringstream words(line);
    if (names.empty()) {
      while (words >> word) names.push_back(word);
      continue;
    }
    for (const std::string& name : names) {
      if (words >> word && name == "RcvbufErrors") return std::stoll(word);
    }
  }
  throw std::runtime_error("no count of RcvbufErrors");
}

// What a robot sees in a while.
struct Reception {
  std::int64_t session = 0, first = -1, last = -1;
  std::int64_t frames = 0, lost = 0, poses = 0, dropped = 0;
  std::int64_t unread = 0;                  // packets that came, but the robot had no time for them
  std::vector<std::int64_t> on_the_way_us;  // from publishing to the robot
  std::vector<std::int64_t> since_taken_us;  // from the frame to the robot
};

Reception receive(std::chrono::seconds how_long) {
  Reception reception;
  Subscriber subscriber(kUrl, "ROUNDEL");
  // Counting begins once frames flow.
  const auto begin = std::chrono::steady_clock::now();
  while (reception.first < 0 && std::chrono::steady_clock::now() < begin + 60s) {
    if (const ReceivedFrame* frame = subscriber.next_frame(100ms)) {
      reception.first = frame->header.frame;
      reception.session = frame->header.session;
    }
  }
  const auto end = std::chrono::steady_clock::now() + how_long;
  const std::int64_t lost_before = subscriber.counts().lost;
  const std::int64_t unread_before = packets_left_unread();
  while (std::chrono::steady_clock::now() < end) {
    const ReceivedFrame* const frame = subscriber.next_frame(100ms);
    // Anybody can send; who knows the session leaves the rest alone.
    if (frame == nullptr || frame->header.session != reception.session) continue;
    ++reception.frames;
    reception.last = frame->header.frame;
    reception.dropped = frame->header.dropped;
    reception.poses += std::count_if(frame->markers.begin(), frame->markers.end(),
                                     [](const marker_t& marker) { return marker.has_pose != 0; });
    reception.on_the_way_us.push_back(subscriber.received_utime() - frame->header.publish_utime);
    reception.since_taken_us.push_back(subscriber.received_utime() - frame->header.capture_utime);
  }
  reception.lost = subscriber.counts().lost - lost_before;
  reception.unread = packets_left_unread() - unread_before;
  return reception;
}

std::string percentiles(std::vector<std::int64_t> values) {
  if (values.empty()) return "none";
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  return fmt::format("{} / {} / {} us", at(0.5), at(0.99), values.back());
}

std::string figures(const Reception& r) {
  return fmt::format(
      "{} frames, {} lost ({} packets came, but were not read in time), {} poses; median / 99th "
      "percentile / worst: {} from publishing, {} from the frame",
      r.frames, r.lost, r.unread, r.poses, percentiles(r.on_the_way_us),
      percentiles(r.since_taken_us));
}

// What somebody in the group might send: noise, and LCM messages of our channels with noise in
// them. Besides, fragments that promise what does not come: where it receives these, liblcm 1.3
// itself may end with a segmentation fault, so no robot may listen meanwhile.
void be_hostile(bool fragments, const std::atomic<bool>& end, std::atomic<std::int64_t>& sent) {
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in group{};
  group.sin_family = AF_INET;
  group.sin_port = htons(7667);
  group.sin_addr.s_addr = htonl(0xEFFF4C43);  // 239.255.76.67
  test::Random random(1);
  std::uint32_t sequence = 0;
  std::vector<char> packet;
  while (!end) {
    packet.resize(static_cast<std::size_t>(8 + random.integer(0, 1400)));
    for (char& c : packet) c = static_cast<char>(random.integer(0, 255));
    const bool fragment = fragments && random.integer(0, 1) == 0;
    const std::uint32_t magic = htonl(fragment ? 0x4c433033 : 0x4c433032);  // "LC03", "LC02"
    const std::uint32_t number = htonl(++sequence);
    if (random.integer(0, 3) > 0) {
      std::memcpy(packet.data(), &magic, sizeof magic);
      std::memcpy(packet.data() + 4, &number, sizeof number);
      const std::string channel = random.integer(0, 1) == 0 ? "ROUNDEL_FRAME" : "ROUNDEL_STATUS";
      if (packet.size() > 8 + channel.size() + 1) {
        std::memcpy(packet.data() + 8, channel.c_str(), channel.size() + 1);
      }
    }
    ::sendto(socket, packet.data(), packet.size(), 0, reinterpret_cast<const sockaddr*>(&group),
             sizeof group);
    if (++sent % 20 == 0) std::this_thread::sleep_for(1ms);
  }
  ::close(socket);
}

// Whether anything on the machine of a process has a socket at LCM's port. (The socket that liblcm
// sends from has joined the group as well, but at a port of its own, and nobody ever reads from
// it.)
bool listens(const std::string& process) {
  const std::string folder = fmt::format("/proc/{}/net/", process);
  std::istringstream sockets(read_file(folder + "udp"));
  std::string line, number, local;
  while (std::getline(sockets, line)) {
    if (std::istringstream(line) >> number >> local && local.ends_with(":1DF3"))
      return true;  // 7667
  }
  return false;
}

}  // namespace

TEST_CASE("a hundred robots at 60 frames/s reach two machines with TTL 1, whoever else sends") {
  if (!multicast_is_private()) return;
  std::string reason;
  const std::optional<Hosts> hosts = Hosts::make(4, reason);
  if (!hosts) {
    MESSAGE("skipped: no network of several machines can be made here: " << reason);
    return;
  }
  const TemporaryDirectory folder;
  const Recording recording(folder);
  ChildProcess daemon(hosts->on(kDaemon, roundeld(recording)));
  constexpr auto kHowLong = 5s;

  const auto both_receive = [&] {
    std::array<Reception, 2> received;
    std::thread first = hosts->thread_on(kFirstRobot, [&] { received[0] = receive(kHowLong); });
    std::thread second = hosts->thread_on(kSecondRobot, [&] { received[1] = receive(kHowLong); });
    first.join();
    second.join();
    return received;
  };
  const auto check = [&](const Reception& reception) {
    REQUIRE(reception.frames > 0);
    // What came and what is said to be lost is all that was sent.
    CHECK(reception.frames + reception.lost == reception.last - reception.first);
    // The network loses next to nothing. On a busy machine a robot may be too slow, which costs a
    // frame for every packet at most.
    CHECK((reception.lost - reception.unread) * 20 < reception.frames);
    CHECK(reception.poses >= reception.frames * (kRobots - 2));
    CHECK(reception.dropped == 0);
  };

  const std::array<Reception, 2> calm = both_receive();
  for (const Reception& reception : calm) {
    MESSAGE(figures(reception));
    check(reception);
  }

  std::atomic<bool> end{false};
  std::atomic<std::int64_t> sent{0};
  std::thread hostile = hosts->thread_on(kHostile, [&] { be_hostile(false, end, sent); });
  const std::array<Reception, 2> attacked = both_receive();
  end = true;
  hostile.join();

  end = false;
  hostile = hosts->thread_on(kHostile, [&] { be_hostile(true, end, sent); });
  while (sent < 20'000) std::this_thread::yield();
  end = true;
  hostile.join();
  const std::array<Reception, 2> afterwards = both_receive();

  MESSAGE(sent.load() << " hostile packets; during and after them:");
  for (const Reception& reception : {attacked[0], attacked[1], afterwards[0], afterwards[1]}) {
    MESSAGE(figures(reception));
    REQUIRE(reception.frames > 0);
    CHECK(reception.session == calm[0].session);
    CHECK(reception.dropped == 0);
    CHECK(reception.poses >= reception.frames * (kRobots - 2));
  }
  // It could not be told anything: it does not listen, as a robot does.
  CHECK_FALSE(listens(std::to_string(daemon.pid())));
  bool robot_listens = false;
  hosts
      ->thread_on(kFirstRobot,
                  [&] {
                    const Subscriber subscriber(kUrl, "ROUNDEL");
                    robot_listens = listens("thread-self");
                  })
      .join();
  CHECK(robot_listens);
  daemon.signal(SIGTERM);
  CHECK(daemon.wait(60s) == 0);
}
