#include "transport/publisher.hpp"

namespace roundel {

Publisher::Publisher(std::shared_ptr<MessageSender> sender, const PublisherParameters& parameters)
    : sender_(std::move(sender)),
      frames_(parameters.channel + "_FRAME", parameters.camera, parameters.max_datagram),
      status_channel_(parameters.channel + "_STATUS") {
  if (parameters.per_marker) poses_.emplace(parameters.channel);
}

TimeStamp Publisher::publish(FrameInformation information, std::span<const Marker> markers,
                             std::span<const ArenaPose> arena) {
  information.published = now();
  sending_ = true;
  for (const Bytes part : frames_.encode(information, markers, arena)) {
    sending_ = send(frames_.channel().c_str(), part) && sending_;
  }
  if (poses_) {
    for (const Marker* marker : poses_->select(markers)) {
      const ArenaPose place =
          arena.empty() ? ArenaPose() : arena[static_cast<std::size_t>(marker - markers.data())];
      sending_ =
          send(poses_->channel(*marker), poses_->encode(information, *marker, place)) && sending_;
    }
  }
  if (!sending_) ++unsent_frames_;
  return information.published;
}

void Publisher::publish(const status_t& status) {
  const auto size = static_cast<std::size_t>(status.getEncodedSize());
  if (status_buffer_.size() < size) status_buffer_.resize(size);
  const int written = status.encode(status_buffer_.data(), 0, static_cast<int>(size));
  send(status_channel_.c_str(), {status_buffer_.data(), static_cast<std::size_t>(written)});
}

bool Publisher::send(const char* channel, Bytes message) {
  return sender_->send(channel, message);
}

}  // namespace roundel
