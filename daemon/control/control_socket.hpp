#pragma once

#include <string>

#include "calibration/unique_fd.hpp"

namespace roundel {

// The listening Unix socket that roundeld is controlled by: mode 0660, for the members of a group.
// Removed from the file system with the object.
class ControlSocket {
 public:
  // Takes the place of a socket that a dead process has left behind; refuses one that is alive, and
  // anything that is no socket. A group that does not exist, or that it may not give away to, is
  // told in `remark`. Throws std::runtime_error that names the path.
  ControlSocket(const std::string& path, const std::string& group);
  ~ControlSocket();
  ControlSocket(const ControlSocket&) = delete;
  ControlSocket& operator=(const ControlSocket&) = delete;

  UniqueFd take_descriptor() { return std::move(descriptor_); }
  const std::string& remark() const { return remark_; }

 private:
  std::string path_;
  UniqueFd descriptor_;
  std::string remark_;
};

}  // namespace roundel
