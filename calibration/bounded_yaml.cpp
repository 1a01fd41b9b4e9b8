#include "calibration/bounded_yaml.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <yaml-cpp/eventhandler.h>

#include <cerrno>
#include <cstring>
#include <sstream>
#include <stdexcept>

#include "calibration/unique_fd.hpp"

namespace roundel {
namespace {

constexpr int kPatienceMs = 5000;  // with a pipe whose writer is slow

class LimitExceeded : public YAML::ParserException {
  using ParserException::ParserException;
};

// Walks a document without building it, and stops at the first limit.
class LimitCheck final : public YAML::EventHandler {
 public:
  explicit LimitCheck(const YamlLimits& limits) : limits_(limits) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++documents_ > 1) throw LimitExceeded(mark, "only one YAML document is expected");
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t /*anchor*/) override { count(mark); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t /*anchor*/) override {
    throw LimitExceeded(mark, "anchors and aliases (&, *) are not accepted here");
  }
  void OnScalar(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                const std::string& /*value*/) override {
    count(mark);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& /*tag*/,
                       YAML::anchor_t /*anchor*/, YAML::EmitterStyle::value /*style*/) override {
    descend(mark);
  }
  void OnSequenceEnd() override { --depth_; }
  void OnMapStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                  YAML::EmitterStyle::value /*style*/) override {
    descend(mark);
  }
  void OnMapEnd() override { --depth_; }

 private:
  void count(const YAML::Mark& mark) {
    if (++nodes_ > limits_.nodes) {
      throw LimitExceeded(mark, fmt::format("more than {} values", limits_.nodes));
    }
  }
  void descend(const YAML::Mark& mark) {
    count(mark);
    if (++depth_ > limits_.depth) {
      throw LimitExceeded(mark, fmt::format("nested deeper than {} levels", limits_.depth));
    }
  }

  YamlLimits limits_;
  int documents_ = 0;
  int depth_ = 0;
  int nodes_ = 0;
};

}  // namespace

std::string read_text_file(const std::string& path, std::size_t max_bytes) {
  const auto fail = [&](const char* what) {
    throw std::runtime_error(fmt::format("{}: {}: {}", path, what, std::strerror(errno)));
  };
  // Of a pipe that nobody writes to, nothing is waited for.
  const UniqueFd file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (!file) fail("can't be opened");
  std::string text(max_bytes + 1, '\0');
  std::size_t size = 0;
  while (size < text.size()) {
    const ssize_t count = ::read(file.get(), text.data() + size, text.size() - size);
    if (count < 0 && errno == EINTR) continue;
    pollfd more = {file.get(), POLLIN, 0};
    if (count < 0 && errno == EAGAIN && ::poll(&more, 1, kPatienceMs) > 0) continue;
    if (count < 0) fail("can't be read");
    if (count == 0) break;
    size += static_cast<std::size_t>(count);
  }
  if (size > max_bytes) {
    throw std::runtime_error(
        fmt::format("{}: too large for such a file, at most {} bytes", path, max_bytes));
  }
  text.resize(size);
  return text;
}

std::string where(const std::string& name, const YAML::Mark& mark) {
  if (mark.is_null()) return name;
  return fmt::format("{}:{}:{}", name, mark.line + 1, mark.column + 1);
}

YAML::Node parse_bounded_yaml(const std::string& text, const std::string& name,
                              const YamlLimits& limits) {
  if (text.size() > limits.bytes) {
    throw std::runtime_error(
        fmt::format("{}: too large for such a file, at most {} bytes", name, limits.bytes));
  }
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    LimitCheck check(limits);
    while (parser.HandleNextDocument(check)) {
    }
    return YAML::Load(text);
  } catch (const LimitExceeded& error) {
    throw std::runtime_error(fmt::format("{}: {}", where(name, error.mark), error.msg));
  } catch (const YAML::Exception& error) {
    throw std::runtime_error(
        fmt::format("{}: not valid YAML: {}", where(name, error.mark), error.msg));
  }
}

}  // namespace roundel
