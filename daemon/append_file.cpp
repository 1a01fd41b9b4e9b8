#include "daemon/append_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace roundel {
namespace {

constexpr mode_t kMode = 0666;  // as the user's umask says

}  // namespace

AppendFile::AppendFile(const std::string& path)
    : name_(path == "-" ? "standard output" : path), descriptor_(STDOUT_FILENO) {
  if (path == "-") return;
  file_ = UniqueFd(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kMode));
  if (!file_) {
    throw std::runtime_error(fmt::format("{} can't be opened: {}", path, std::strerror(errno)));
  }
  descriptor_ = file_.get();
}

void AppendFile::append(std::string_view first, std::string_view second) {
  write_all(first);
  write_all(second);
  last_size_ = static_cast<std::int64_t>(first.size() + second.size());
  size_ += last_size_;
}

void AppendFile::write_all(std::string_view part) {
  while (!part.empty()) {
    const ssize_t written = ::write(descriptor_, part.data(), part.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail();
    part.remove_prefix(static_cast<std::size_t>(written));
  }
}

void AppendFile::close() {
  if (file_ && ::close(file_.release()) != 0) fail();
}

void AppendFile::take_back() {
  size_ -= std::exchange(last_size_, 0);
  cut();
}

void AppendFile::cut() {
  if (file_ && ::ftruncate(file_.get(), size_) == 0) ::lseek(file_.get(), size_, SEEK_SET);
}

void AppendFile::fail() {
  const int error = errno;
  cut();
  throw std::runtime_error(fmt::format("{} can't be written: {}", name_, std::strerror(error)));
}

}  // namespace roundel
