#include "daemon/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <initializer_list>
#include <stdexcept>
#include <string_view>

namespace roundel {
namespace {

namespace fs = std::filesystem;

bool has_extension(const fs::path& path, std::initializer_list<std::string_view> extensions) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

bool is_video(const fs::path& path) {
  return has_extension(path, {".y4m"});
}

void add_folder(const std::string& folder, std::vector<std::string>& files) {
  std::error_code error;
  std::vector<std::string> found;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code unknown;
    if (has_extension(entry->path(), {".png", ".jpg", ".jpeg", ".pgm"}) &&
        !entry->is_fifo(unknown)) {
      found.push_back(entry->path().string());
    }
  }
  if (error) throw std::runtime_error(fmt::format("{}: {}", folder, error.message()));
  if (found.empty()) {
    throw std::runtime_error(
        fmt::format("{}: no images (.png, .jpg, .pgm) in this folder", folder));
  }
  std::sort(found.begin(), found.end());
  files.insert(files.end(), found.begin(), found.end());
}

}  // namespace

Recording::Recording(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (!fs::exists(status)) {
      throw std::runtime_error(fmt::format("{}: no such file or folder", path));
    }
    if (fs::is_directory(status)) {
      add_folder(path, files_);
    } else {
      files_.push_back(path);
    }
  }
  if (files_.empty()) throw std::runtime_error("no files to play");
}

bool Recording::next(GreyImage& frame) {
  for (;;) {
    if (video_) {
      try {
        if (video_->next(frame)) return true;
      } catch (...) {
        video_.reset();  // the rest of a damaged video is left out
        throw;
      }
      video_.reset();
    }
    if (next_file_ == files_.size()) return false;
    const std::string& file = files_[next_file_++];
    if (is_video(file)) {
      video_ = std::make_unique<Y4mReader>(file);
    } else {
      loader_.load(file, frame);
      return true;
    }
  }
}

void Recording::rewind() {
  video_.reset();
  next_file_ = 0;
}

}  // namespace roundel
