#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "core/grey_image.hpp"
#include "daemon/image_file.hpp"
#include "daemon/y4m.hpp"

namespace roundel {

// The frames of images, folders of images (in the order of names) and .y4m videos, one after
// another.
class Recording {
 public:
  // Throws std::runtime_error if a path does not exist or a folder has no images.
  explicit Recording(const std::vector<std::string>& paths);

  // The next frame; false at the end. Throws std::runtime_error that names the file for one that
  // can't be read; the next call goes on behind it.
  bool next(GreyImage& frame);

  // Goes back to the first frame.
  void rewind();

  std::size_t file_count() const { return files_.size(); }
  const std::string& first_file() const { return files_.front(); }

 private:
  std::vector<std::string> files_;  // not empty, no folders
  std::size_t next_file_ = 0;
  std::unique_ptr<Y4mReader> video_;  // being read, or none
  ImageLoader loader_;
};

}  // namespace roundel
