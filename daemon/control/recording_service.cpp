#include "daemon/control/recording_service.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "daemon/control/ask_loop.hpp"
#include "daemon/control/recording_json.hpp"
#include "daemon/json_frame.hpp"

namespace roundel {
namespace {

class RecordingStream final : public HttpStream {
 public:
  RecordingStream(std::shared_ptr<RecordingQueue> queue, std::string heading)
      : queue_(std::move(queue)), text_(std::move(heading)) {}
  ~RecordingStream() override { queue_->close(); }

  std::size_t read(char* out, std::size_t room) override {
    if (sent_ == text_.size() + pixels_.size() && !take_next()) return 0;
    const bool in_text = sent_ < text_.size();
    const std::string_view part =
        in_text ? std::string_view(text_).substr(sent_) : pixels_.substr(sent_ - text_.size());
    const std::size_t size = part.copy(out, room);
    sent_ += size;
    return size;
  }

 private:
  bool take_next() {
    if (has_entry_) queue_->pop();
    const RecordingQueue::Entry* const entry = queue_->front();
    has_entry_ = entry != nullptr;
    sent_ = 0;
    text_.clear();
    pixels_ = {};
    if (entry == nullptr) return false;
    text_ = json_line(recorded_frame_json(*entry));
    const GreyImage& picture = entry->frame.picture;
    pixels_ = {reinterpret_cast<const char*>(picture.pixels.data()), picture.pixels.size()};
    return true;
  }

  std::shared_ptr<RecordingQueue> queue_;
  bool has_entry_ = false;  // the queue's front is being sent
  std::string text_;
  std::string_view pixels_;  // of the queue's front
  std::size_t sent_ = 0;     // of both
};

}  // namespace

std::unique_ptr<HttpStream> RecordingService::start(const FrameSnapshot& newest, double frame_rate,
                                                    bool restart) {
  const FrameInformation& frame = newest.information;
  const auto queue = std::make_shared<RecordingQueue>(frame.width, frame.height);
  {
    const std::lock_guard lock(mutex_);
    if (!queues_.empty() && !queues_.back()->closed()) {
      throw std::logic_error("somebody else is recording; roundeld serves one recording at a time");
    }
    queues_.push_back(queue);
  }
  try {
    const Configuration configuration = ask_loop(loop_, [queue, restart](LoopControl& control) {
      control.start_recording(queue, restart);
      return control.configuration();
    });
    return std::make_unique<RecordingStream>(
        queue, json_line(recording_json(newest, configuration, frame_rate, restart)));
  } catch (...) {
    queue->close();
    throw;
  }
}

void RecordingService::on_tick() {
  const std::lock_guard lock(mutex_);
  std::erase_if(queues_, [](const std::shared_ptr<RecordingQueue>& queue) {
    return queue->closed() && queue.use_count() == 1;
  });
}

}  // namespace roundel
