#include "tools/json_lines.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace roundel {
namespace {

using Json = nlohmann::ordered_json;

FilePointer open_file(const std::string& path) {
  FilePointer file(std::fopen(path.c_str(), "rbe"));
  if (!file) {
    throw std::runtime_error(fmt::format("{} can't be opened: {}", path, std::strerror(errno)));
  }
  return file;
}

}  // namespace

JsonLines::JsonLines(const std::string& path)
    : name_(path == "-" ? "standard input" : path),
      file_(path == "-" ? nullptr : open_file(path)),
      stream_(file_ ? file_.get() : stdin) {}

void JsonLines::fail(std::string_view what) const {
  throw std::runtime_error(fmt::format("{}:{}: {}", name_, number_, what));
}

bool JsonLines::read_line() {
  line_.clear();
  ++number_;
  for (int c = std::getc(stream_); c != '\n'; c = std::getc(stream_)) {
    if (c == EOF) {
      if (std::ferror(stream_) != 0) {
        fail(fmt::format("can't be read: {}", std::strerror(errno)));
      }
      return !line_.empty();
    }
    if (line_.size() == kMaxLine) {
      fail(fmt::format("is longer than {} bytes", kMaxLine));
    }
    line_.push_back(static_cast<char>(c));
  }
  return true;
}

std::optional<Json> JsonLines::next() {
  if (!read_line()) {
    return std::nullopt;
  }
  const auto bounded = [this](int depth, Json::parse_event_t, Json&) {
    if (depth > kMaxDepth) {
      fail(fmt::format("is nested more than {} deep", kMaxDepth));
    }
    return true;
  };
  try {
    return Json::parse(line_, bounded);
  } catch (const Json::parse_error& error) {
    fail(fmt::format("is not JSON (character {})", error.byte));
  } catch (const Json::exception&) {  // a number that is none of ours
    fail("is not JSON that can be read");
  }
}

}  // namespace roundel
