#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "transport/frame_encoder.hpp"
#include "transport/lcm_link.hpp"
#include "transport/message_sender.hpp"
#include "transport/pose_encoder.hpp"

namespace roundel {

struct PublisherParameters {
  std::string channel = "ROUNDEL";  // prefix of all channels
  std::string camera;               // name of the camera, part of every frame message
  bool per_marker = false;          // also <prefix>_POSE_<id>
  int max_datagram = 1400;          // bytes, with LCM's header and channel
};

// Broadcasts frames and status over LCM. Not thread-safe. publish() allocates nothing after the
// first frames, and never waits for a receiver.
class Publisher {
 public:
  // Throws std::invalid_argument if max_datagram is too small.
  Publisher(std::shared_ptr<MessageSender> sender, const PublisherParameters& parameters);
  Publisher(LcmLink link, const PublisherParameters& parameters)
      : Publisher(std::make_shared<LcmSender>(std::move(link)), parameters) {}

  // Sends all parts of a frame, then the single poses. Sets the publish time in both clocks and
  // returns it. Every frame goes out, also without markers.
  // `arena` has one entry a marker, or none at all.
  TimeStamp publish(FrameInformation information, std::span<const Marker> markers,
                    std::span<const ArenaPose> arena = {});
  void publish(const status_t& status);

  // Frames that could not be given to the network as a whole (its interface is down, for example).
  std::int64_t unsent_frames() const { return unsent_frames_; }
  // Whether the last frame was.
  bool sending() const { return sending_; }

 private:
  bool send(const char* channel, Bytes message);

  std::shared_ptr<MessageSender> sender_;
  FrameEncoder frames_;
  std::optional<PoseEncoder> poses_;
  std::string status_channel_;
  std::vector<std::uint8_t> status_buffer_;
  std::int64_t unsent_frames_ = 0;
  bool sending_ = true;
};

}  // namespace roundel
