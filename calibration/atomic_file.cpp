#include "calibration/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include "calibration/unique_fd.hpp"

namespace roundel {
namespace {

[[noreturn]] void fail(const std::string& path, const char* what) {
  throw std::runtime_error(fmt::format("{}: {}: {}", path, what, std::strerror(errno)));
}

// Removes the temporary file unless it has been renamed.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& path) : name_(path + ".XXXXXX") {
    descriptor_ = UniqueFd(::mkostemp(name_.data(), O_CLOEXEC));
    if (!descriptor_) fail(path, "can't be written");
  }
  ~TemporaryFile() {
    if (!name_.empty()) ::unlink(name_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  int descriptor() const { return descriptor_.get(); }
  void rename_to(const std::string& path) {
    if (::rename(name_.c_str(), path.c_str()) != 0) fail(path, "can't be replaced");
    name_.clear();
  }

 private:
  std::string name_;
  UniqueFd descriptor_;
};

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

}  // namespace

void require_writable(const std::string& path) {
  const TemporaryFile probe(path);
}

void write_file_atomically(const std::string& path, std::string_view contents) {
  constexpr mode_t kMode = 0644;
  TemporaryFile file(path);
  while (!contents.empty()) {
    const ssize_t written = ::write(file.descriptor(), contents.data(), contents.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(path, "can't be written");
    contents.remove_prefix(static_cast<std::size_t>(written));
  }
  if (::fchmod(file.descriptor(), kMode) != 0) fail(path, "can't be made readable");
  if (::fsync(file.descriptor()) != 0) fail(path, "can't be synced");
  file.rename_to(path);
  const UniqueFd folder(::open(folder_of(path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!folder || ::fsync(folder.get()) != 0) fail(path, "its folder can't be synced");
}

}  // namespace roundel
