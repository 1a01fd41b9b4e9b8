#include "daemon/control/control_socket.hpp"

#include <fmt/format.h>
#include <grp.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace roundel {
namespace {

[[noreturn]] void fail(const std::string& path, const std::string& what) {
  throw std::runtime_error(fmt::format("{}: {}", path, what));
}

sockaddr_un address_of(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof address.sun_path) {
    fail(path, "a socket's path has 1 to 107 characters");
  }
  path.copy(address.sun_path, path.size());
  return address;
}

UniqueFd unix_socket() {
  return UniqueFd(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
}

// As a service does from the start, which may not change owners.
bool belongs_to(const std::string& path, gid_t group) {
  struct stat status {};
  return ::lstat(path.c_str(), &status) == 0 && status.st_gid == group;
}

void make_room(const std::string& path, const sockaddr_un& address) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0) return;
  if (!S_ISSOCK(status.st_mode)) fail(path, "is there and is no socket");
  const UniqueFd probe = unix_socket();
  const auto* const generic = reinterpret_cast<const sockaddr*>(&address);
  if (::connect(probe.get(), generic, sizeof address) == 0 || errno == EAGAIN) {
    fail(path, "another roundeld is controlled there");
  }
  ::unlink(path.c_str());
}

}  // namespace

ControlSocket::ControlSocket(const std::string& path, const std::string& group)
    : path_(path), descriptor_(unix_socket()) {
  constexpr int kBacklog = 128;
  constexpr mode_t kOwnerOnly = 0600, kGroup = 0660;
  const sockaddr_un address = address_of(path);
  if (!descriptor_) fail(path, std::strerror(errno));
  make_room(path, address);
  // Nobody else gets in before the group is set: bind() takes the mode over.
  ::fchmod(descriptor_.get(), kOwnerOnly);
  const auto* const generic = reinterpret_cast<const sockaddr*>(&address);
  if (::bind(descriptor_.get(), generic, sizeof address) != 0) fail(path, std::strerror(errno));
  if (!group.empty()) {
    const ::group* const entry = ::getgrnam(group.c_str());
    if (entry == nullptr) {
      remark_ = fmt::format("there is no group {}: only this user's own group may use it", group);
    } else if (!belongs_to(path, entry->gr_gid) &&
               ::chown(path.c_str(), static_cast<uid_t>(-1), entry->gr_gid) != 0) {
      remark_ = fmt::format("it can't be given to group {}: {}", group, std::strerror(errno));
    }
  }
  if (::chmod(path.c_str(), kGroup) != 0 || ::listen(descriptor_.get(), kBacklog) != 0) {
    const int reason = errno;
    ::unlink(path.c_str());
    fail(path, std::strerror(reason));
  }
}

ControlSocket::~ControlSocket() {
  ::unlink(path_.c_str());
}

}  // namespace roundel
