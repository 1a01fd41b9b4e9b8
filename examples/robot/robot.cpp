// A robot that knows where it is: it listens for its own marker in every frame that roundeld
// broadcasts, and stops when it has not been seen for a while.
//
//   robot ID [URL]     for example: robot 7 udpm://239.255.76.67:7667?ttl=1
//
// If roundeld sends to this robot alone (lcm.copies: [udpm://ROBOT:7667]), the URL stays the same:
// what counts is the port.
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <lcm/lcm-cpp.hpp>
#include <roundel/frame_t.hpp>

namespace {

std::int64_t now_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

class Robot {
 public:
  explicit Robot(int id) : id_(id) {}

  // A frame may come in parts, each with some of the markers. Who looks for one marker need not put
  // them together.
  void on_frame(const lcm::ReceiveBuffer* /*buffer*/, const std::string& /*channel*/,
                const roundel::frame_t* frame) {
    for (const roundel::marker_t& marker : frame->markers) {
      if (marker.id == id_) on_pose(frame->header, marker);
    }
  }

  // To be called now and then, also while nothing comes.
  void on_tick() {
    constexpr std::int64_t kTooOldUs = 500'000;
    const bool lost = now_us() - seen_us_ > kTooOldUs;
    if (lost && !lost_) std::cout << "not seen: stop" << std::endl;
    lost_ = lost;
  }

 private:
  void on_pose(const roundel::header_t& header, const roundel::marker_t& marker) {
    // This machine's clock, not the camera's: it also works where the two do not agree.
    seen_us_ = now_us();
    if (seen_us_ - told_us_ < 500'000 && !lost_) return;
    told_us_ = seen_us_;
    lost_ = false;
    if (marker.has_arena) {
      std::cout << "arena: x " << marker.arena_x << " m, y " << marker.arena_y << " m, heading "
                << marker.arena_heading << " rad";
    } else if (marker.has_pose) {
      std::cout << "camera: x " << marker.position[0] << " m, y " << marker.position[1] << " m, z "
                << marker.position[2] << " m";
    } else {
      std::cout << "image: u " << marker.u << " px, v " << marker.v << " px";
    }
    // Says something only where both clocks follow the same reference (docs/guide/network.md).
    std::cout << "; frame " << header.frame << ", "
              << static_cast<double>(seen_us_ - header.capture_utime) / 1000 << " ms old"
              << std::endl;
  }

  int id_;
  std::int64_t seen_us_ = now_us(), told_us_ = 0;
  bool lost_ = false;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    std::cerr << "usage: robot ID [URL]" << std::endl;
    return 2;
  }
  lcm::LCM link(argc > 2 ? argv[2] : "udpm://239.255.76.67:7667?ttl=0");
  if (!link.good()) return 1;
  Robot robot(std::atoi(argv[1]));
  // The default queue of 30 messages loses parts of large frames.
  link.subscribe("ROUNDEL_FRAME", &Robot::on_frame, &robot)->setQueueCapacity(1000);
  while (link.handleTimeout(100) >= 0) robot.on_tick();
  return 1;
}
