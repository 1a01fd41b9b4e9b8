#pragma once

#include <cstdint>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/file_pointer.hpp"

namespace roundel {

// Reads JSON Lines, one value a line, from files that nobody vouches for: a line's length and its
// nesting are bounded. All errors are std::runtime_error "file:line: what is wrong".
class JsonLines {
 public:
  static constexpr std::size_t kMaxLine = std::size_t{8} << 20;  // some 9000 markers
  static constexpr int kMaxDepth = 16;

  // Opens the file ("-": standard input).
  explicit JsonLines(const std::string& path);

  // The next line's value; nothing at the end of the file.
  std::optional<nlohmann::ordered_json> next();

  // Throws the error for the line read last.
  [[noreturn]] void fail(std::string_view what) const;

  const std::string& name() const { return name_; }

 private:
  bool read_line();

  std::string name_;
  FilePointer file_;  // owns; empty for standard input
  std::FILE* stream_ = nullptr;
  std::string line_;
  std::int64_t number_ = 0;  // of the line read last, from 1
};

}  // namespace roundel
