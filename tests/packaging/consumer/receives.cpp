// The LCM types in C++: a message there and back.
#include <lcm/lcm-cpp.hpp>
#include <roundel/frame_t.hpp>
#include <roundel/status_t.hpp>

#include <vector>

int main() {
  roundel::frame_t frame{};
  frame.markers.resize(2);
  frame.num_markers = 2;
  frame.markers[1].id = 7;
  std::vector<char> bytes(frame.getEncodedSize());
  frame.encode(bytes.data(), 0, bytes.size());
  roundel::frame_t received;
  received.decode(bytes.data(), 0, bytes.size());
  lcm::LCM link("memq://");
  return received.markers.at(1).id == 7 && link.good() ? 0 : 1;
}
