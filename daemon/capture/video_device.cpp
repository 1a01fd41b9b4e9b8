#include "daemon/capture/video_device.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

namespace roundel {

std::string reason_of(int error) {
  switch (error) {
    case ENODEV:
    case ENXIO:
    case ENOENT:
      return "it is not there (unplugged?)";
    case EBUSY:
      return "another program uses it";
    case EACCES:
    case EPERM:
      return "permission denied (is this user in the group video?)";
    case EIO:
      return "input/output error";
    default:
      return std::strerror(error);  // NOLINT(concurrency-mt-unsafe)
  }
}

void VideoDevice::require(unsigned long request, void* argument, const std::string& what) {
  const int error = control(request, argument);
  if (error != 0) throw CameraError(fmt::format("{}: {}", what, reason_of(error)));
}

}  // namespace roundel
