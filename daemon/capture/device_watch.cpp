#include "daemon/capture/device_watch.hpp"

#include <sys/inotify.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <system_error>

namespace roundel {

DeviceWatch::DeviceWatch(const char* folder)
    : descriptor_(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {
  if (!descriptor_) throw std::system_error(errno, std::generic_category(), "inotify");
  ::inotify_add_watch(descriptor_.get(), folder,
                      IN_CREATE | IN_DELETE | IN_ATTRIB | IN_MOVED_FROM | IN_MOVED_TO);
}

bool DeviceWatch::take() {
  bool changed = false;
  alignas(inotify_event) std::array<char, 4096> events{};
  for (;;) {
    const ssize_t length = ::read(descriptor_.get(), events.data(), events.size());
    if (length <= 0) return changed;
    for (std::size_t at = 0; at < static_cast<std::size_t>(length);) {
      inotify_event event{};
      std::memcpy(&event, events.data() + at, sizeof(event));
      const char* const name = events.data() + at + sizeof(event);
      if (event.len > 0 && std::string_view(name).starts_with("video")) changed = true;
      at += sizeof(event) + event.len;
    }
  }
}

}  // namespace roundel
