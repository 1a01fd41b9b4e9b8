#include "calibration/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <system_error>

namespace roundel {
namespace {

[[noreturn]] void fail(const std::string& path, const char* what) {
  throw std::runtime_error(fmt::format("{}: {}: {}", path, what, std::strerror(errno)));
}

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

constexpr std::string_view kRandomPart = ".XXXXXX", kEnding = ".new";

// Those that nobody has locked: who made them is gone.
void remove_left_behind(const std::string& path) {
  const std::string start = std::filesystem::path(path).filename();
  std::error_code error;
  std::filesystem::directory_iterator entry(folder_of(path), error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename();
    if (name.size() != start.size() + kRandomPart.size() + kEnding.size() ||
        !name.starts_with(start + ".") || !name.ends_with(kEnding)) {
      continue;
    }
    const UniqueFd file(
        ::open(entry->path().c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    if (file && ::flock(file.get(), LOCK_EX | LOCK_NB) == 0) ::unlink(entry->path().c_str());
  }
}

}  // namespace

StagedFile::StagedFile(const std::string& path, std::string_view contents) : path_(path) {
  constexpr mode_t kMode = 0644;
  remove_left_behind(path);
  std::string name = path;
  name.append(kRandomPart).append(kEnding);
  descriptor_ = UniqueFd(::mkostemps(name.data(), static_cast<int>(kEnding.size()), O_CLOEXEC));
  if (!descriptor_) fail(path, "can't be written");
  name_ = name;
  try {
    ::flock(descriptor_.get(), LOCK_EX | LOCK_NB);
    while (!contents.empty()) {
      const ssize_t written = ::write(descriptor_.get(), contents.data(), contents.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail(path, "can't be written");
      contents.remove_prefix(static_cast<std::size_t>(written));
    }
    if (::fchmod(descriptor_.get(), kMode) != 0) fail(path, "can't be made readable");
    if (::fsync(descriptor_.get()) != 0) fail(path, "can't be synced");
  } catch (...) {
    ::unlink(name_.c_str());
    throw;
  }
}

StagedFile::~StagedFile() {
  if (!name_.empty()) ::unlink(name_.c_str());
}

void StagedFile::take_its_place() {
  if (::rename(name_.c_str(), path_.c_str()) != 0) fail(path_, "can't be replaced");
  name_.clear();
  sync_folder_of(path_);
}

void sync_folder_of(const std::string& path) {
  const UniqueFd folder(::open(folder_of(path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!folder || ::fsync(folder.get()) != 0) fail(path, "its folder can't be synced");
}

void require_writable(const std::string& path) {
  const StagedFile probe(path, "");
}

void write_file_atomically(const std::string& path, std::string_view contents) {
  StagedFile(path, contents).take_its_place();
}

}  // namespace roundel
