#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "calibration/unique_fd.hpp"

namespace roundel {

// A new file that grows by pieces. A piece that can't be written whole (a full disk) is taken away
// again, so that the file always ends behind one. Errors are std::runtime_error that names the
// file.
class AppendFile {
 public:
  // Makes the file, or empties it. "-" is standard output, from which nothing can be taken back.
  explicit AppendFile(const std::string& path);

  // One piece, in two parts.
  void append(std::string_view first, std::string_view second = {});

  // Takes the piece written last away again; once.
  void take_back();

  void close();

  const std::string& name() const { return name_; }

 private:
  void write_all(std::string_view part);
  void cut();
  [[noreturn]] void fail();

  std::string name_;
  UniqueFd file_;  // owns; empty for standard output
  int descriptor_ = -1;
  std::int64_t size_ = 0;       // of whole pieces
  std::int64_t last_size_ = 0;  // of the last of them
};

}  // namespace roundel
