#pragma once

#include <cstdio>
#include <memory>

namespace roundel {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

// Owns an open C stream.
using FilePointer = std::unique_ptr<std::FILE, CloseFile>;

}  // namespace roundel
