#include "tests/daemon/capture/fake_camera.hpp"

#include <sys/eventfd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "transport/clock.hpp"

namespace roundel {
namespace {

using State = FakeCamera::State;

class FakeDevice final : public VideoDevice {
 public:
  FakeDevice(std::shared_ptr<State> state, bool converted)
      : state_(std::move(state)), converted_(converted) {
    ++state_->opens;
    ++state_->open_now;
  }
  ~FakeDevice() override {
    --state_->open_now;
    if (streams_) state_->streaming = false;
  }
  FakeDevice(const FakeDevice&) = delete;
  FakeDevice& operator=(const FakeDevice&) = delete;

  int descriptor() const override { return state_->ready.get(); }

  void* map(std::size_t length, std::int64_t offset) override {
    const auto index = static_cast<std::size_t>(offset) / 4096;
    if (state_->refuse_maps) return nullptr;
    if (index >= state_->memory.size() || length > state_->memory[index].size()) return nullptr;
    ++state_->mapped_now;
    return state_->memory[index].data();
  }
  void unmap(void*, std::size_t) override { --state_->mapped_now; }

  int control(unsigned long request, void* argument) override {
    if (!state_->plugged) return ENODEV;
    if (const auto error = state_->errors.find(request); error != state_->errors.end()) {
      return error->second;
    }
    switch (request) {
      case VIDIOC_ENUM_FMT:
        return enumerate_format(*static_cast<v4l2_fmtdesc*>(argument));
      case VIDIOC_ENUM_FRAMESIZES:
        return enumerate_size(*static_cast<v4l2_frmsizeenum*>(argument));
      case VIDIOC_ENUM_FRAMEINTERVALS:
        return enumerate_interval(*static_cast<v4l2_frmivalenum*>(argument));
      case VIDIOC_G_FMT:
      case VIDIOC_S_FMT:
        return format(*static_cast<v4l2_format*>(argument), request == VIDIOC_S_FMT);
      case VIDIOC_G_PARM:
      case VIDIOC_S_PARM:
        static_cast<v4l2_streamparm*>(argument)->parm.capture.timeperframe = state_->interval;
        return 0;
      case VIDIOC_REQBUFS:
        return request_buffers(*static_cast<v4l2_requestbuffers*>(argument));
      case VIDIOC_QUERYBUF:
        return describe(*static_cast<v4l2_buffer*>(argument));
      case VIDIOC_QBUF:
        return queue(*static_cast<v4l2_buffer*>(argument));
      case VIDIOC_DQBUF:
        return dequeue(*static_cast<v4l2_buffer*>(argument));
      case VIDIOC_STREAMON:
        if (state_->busy_starts > 0 && state_->busy_starts-- > 0) return EBUSY;
        ++state_->starts;
        state_->streaming = streams_ = true;
        return 0;
      case VIDIOC_STREAMOFF:
        state_->streaming = streams_ = false;
        state_->queued.clear();
        return 0;
      case VIDIOC_QUERY_EXT_CTRL:
        return query(*static_cast<v4l2_query_ext_ctrl*>(argument));
      case VIDIOC_QUERYMENU:
        return menu(*static_cast<v4l2_querymenu*>(argument));
      case VIDIOC_G_EXT_CTRLS:
      case VIDIOC_S_EXT_CTRLS:
        return value(*static_cast<v4l2_ext_controls*>(argument), request == VIDIOC_S_EXT_CTRLS);
      default:
        return ENOTTY;
    }
  }

 private:
  int enumerate_format(v4l2_fmtdesc& format) const {
    std::vector<std::uint32_t> all = state_->formats;
    const std::size_t native = all.size();
    if (converted_) all.insert(all.end(), state_->emulated.begin(), state_->emulated.end());
    if (format.index >= all.size() && !state_->endless) return EINVAL;
    format.pixelformat = all[format.index % all.size()];
    if (format.index >= native) format.flags = V4L2_FMT_FLAG_EMULATED;
    return 0;
  }
  int enumerate_size(v4l2_frmsizeenum& size) const {
    if (size.index > 0 && !state_->endless) return EINVAL;
    size.type = V4L2_FRMSIZE_TYPE_DISCRETE;
    size.discrete = {static_cast<std::uint32_t>(state_->width),
                     static_cast<std::uint32_t>(state_->height)};
    return 0;
  }
  int enumerate_interval(v4l2_frmivalenum& interval) const {
    if (interval.index > 0 && !state_->endless) return EINVAL;
    interval.type = V4L2_FRMIVAL_TYPE_DISCRETE;
    interval.discrete = state_->interval;
    return 0;
  }
  int format(v4l2_format& format, bool set) const {
    const auto width = static_cast<std::uint32_t>(state_->forced_width != 0 ? state_->forced_width
                                                                            : state_->width);
    const auto height = static_cast<std::uint32_t>(state_->height);
    if (state_->multiplanar) {
      v4l2_pix_format_mplane& pixels = format.fmt.pix_mp;
      if (set) state_->set_fourcc = pixels.pixelformat;
      pixels.width = width;
      pixels.height = height;
      pixels.num_planes = 2;
      pixels.plane_fmt[0].bytesperline = state_->row_stride;
      pixels.field = V4L2_FIELD_NONE;
    } else {
      v4l2_pix_format& pixels = format.fmt.pix;
      if (set) state_->set_fourcc = pixels.pixelformat;
      if (state_->forced_fourcc != 0) pixels.pixelformat = state_->forced_fourcc;
      pixels.width = width;
      pixels.height = height;
      pixels.bytesperline = state_->row_stride;
      pixels.field = V4L2_FIELD_NONE;
    }
    return 0;
  }
  int request_buffers(v4l2_requestbuffers& request) const {
    request.capabilities = state_->capabilities;
    if ((state_->capabilities & V4L2_BUF_CAP_SUPPORTS_MMAP_CACHE_HINTS) == 0) request.flags = 0;
    if (request.count == 0) return 0;
    if (state_->buffer_count != 0) request.count = state_->buffer_count;
    state_->memory.assign(std::min(request.count, 64U),
                          std::vector<std::uint8_t>(state_->buffer_bytes));
    state_->queued.clear();
    state_->deliveries.clear();
    return 0;
  }
  int describe(v4l2_buffer& buffer) const {
    if (buffer.index >= state_->memory.size()) return EINVAL;
    if (state_->multiplanar) {
      buffer.m.planes[0].length = state_->buffer_bytes;
      buffer.m.planes[0].m.mem_offset = 4096 * buffer.index;
    } else {
      buffer.length = state_->buffer_bytes;
      buffer.m.offset = 4096 * buffer.index;
    }
    return 0;
  }
  int queue(const v4l2_buffer& buffer) const {
    if (state_->refuse_queue) return EINVAL;
    state_->queued.push_back(buffer.index);
    return 0;
  }
  int dequeue(v4l2_buffer& buffer) const {
    if (state_->error != 0) return state_->error;
    if (state_->deliveries.empty()) return EAGAIN;
    const FakeCamera::Delivery delivery = state_->deliveries.front();
    if (!delivery.index && state_->queued.empty()) return EAGAIN;
    state_->deliveries.pop_front();
    std::uint64_t count = 0;
    static_cast<void>(!::read(state_->ready.get(), &count, sizeof(count)));
    buffer.index = delivery.index ? *delivery.index : state_->queued.front();
    if (!delivery.index) {
      state_->queued.pop_front();
      std::vector<std::uint8_t>& memory = state_->memory[buffer.index];
      std::fill(memory.begin(), memory.end(), delivery.fill);
    }
    const std::uint32_t used = delivery.bytes_used.value_or(state_->buffer_bytes);
    if (state_->multiplanar) {
      buffer.m.planes[0].bytesused = used;
      buffer.m.planes[0].data_offset = delivery.data_offset;
    } else {
      buffer.bytesused = used;
    }
    buffer.sequence = delivery.sequence;
    buffer.flags = delivery.flags | (delivery.no_clock ? 0U : V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC);
    const std::int64_t now_us = now().mono_us;
    buffer.timestamp = delivery.stamp.value_or(timeval{now_us / 1'000'000, now_us % 1'000'000});
    return 0;
  }

  FakeCamera::FakeControl* find(std::uint32_t id) const {
    for (FakeCamera::FakeControl& control : state_->controls) {
      if (control.id == id) return &control;
    }
    return nullptr;
  }
  bool owned(const FakeCamera::FakeControl& control) const {
    const FakeCamera::FakeControl* const owner = find(control.owner);
    return owner != nullptr && owner->value != 1;
  }
  int query(v4l2_query_ext_ctrl& query) const {
    const bool next = (query.id & V4L2_CTRL_FLAG_NEXT_CTRL) != 0;
    const std::uint32_t id = query.id & ~V4L2_CTRL_FLAG_NEXT_CTRL;
    for (const FakeCamera::FakeControl& control : state_->controls) {
      if (!state_->endless && (next ? control.id <= id : control.id != id)) continue;
      query = {};
      query.id = control.id;
      query.type = control.type;
      std::strncpy(query.name, control.label.c_str(), sizeof(query.name) - 1);
      query.minimum = control.minimum;
      query.maximum = control.maximum;
      query.step = 1;
      query.flags = control.flags | (owned(control) ? V4L2_CTRL_FLAG_INACTIVE : 0U);
      return 0;
    }
    return EINVAL;
  }
  int menu(v4l2_querymenu& item) const {
    const FakeCamera::FakeControl* const control = find(item.id);
    if (control == nullptr || item.index >= control->menu.size()) return EINVAL;
    if (control->menu[item.index].empty()) return EINVAL;
    std::strncpy(reinterpret_cast<char*>(item.name), control->menu[item.index].c_str(),
                 sizeof(item.name) - 1);
    return 0;
  }
  int value(v4l2_ext_controls& request, bool set) const {
    v4l2_ext_control& entry = request.controls[0];
    FakeCamera::FakeControl* const control = find(entry.id);
    if (control == nullptr) return EINVAL;
    if (!set) {
      entry.value = static_cast<std::int32_t>(control->value);
      return 0;
    }
    state_->control_order.push_back(entry.id);
    if (owned(*control)) return EACCES;
    control->value = entry.value;
    return 0;
  }

  std::shared_ptr<State> state_;
  bool converted_;
  bool streams_ = false;
};

}  // namespace

FakeCamera::FakeCamera() : state_(std::make_shared<State>()) {
  state_->formats = {V4L2_PIX_FMT_GREY};
  state_->ready = UniqueFd(::eventfd(0, EFD_NONBLOCK | EFD_SEMAPHORE | EFD_CLOEXEC));
}

std::vector<CameraInformation> FakeCamera::cameras() const {
  std::vector<CameraInformation> all;
  if (state_->plugged && state_->listed) {
    all.push_back({"/dev/video0", {}, "Fake", "usb-1", "A", "fake", state_->multiplanar, ""});
  }
  all.insert(all.end(), state_->others.begin(), state_->others.end());
  return all;
}

std::unique_ptr<VideoDevice> FakeCamera::open(const std::string&) const {
  return std::make_unique<FakeDevice>(state_, false);
}
std::unique_ptr<VideoDevice> FakeCamera::open_converted(const std::string&) const {
  return std::make_unique<FakeDevice>(state_, true);
}

void FakeCamera::deliver(const Delivery& delivery) {
  state_->deliveries.push_back(delivery);
  const std::uint64_t one = 1;
  static_cast<void>(!::write(state_->ready.get(), &one, sizeof(one)));
}

void FakeCamera::break_off(int error) {
  state_->error = error;
  const std::uint64_t one = 1;
  static_cast<void>(!::write(state_->ready.get(), &one, sizeof(one)));
}

}  // namespace roundel
