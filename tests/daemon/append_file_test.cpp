#include "daemon/append_file.hpp"

#include <doctest/doctest.h>
#include <sys/resource.h>

#include <csignal>

#include "tests/error_of.hpp"
#include "tests/temporary_directory.hpp"

using namespace roundel;

namespace {

// While it lives, the kernel refuses what is beyond so many bytes of a file, as a full disk would.
class FileLimit {
 public:
  explicit FileLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileLimit(const FileLimit&) = delete;
  FileLimit& operator=(const FileLimit&) = delete;

 private:
  void (*handler_)(int);
  rlimit before_{};
};

}  // namespace

TEST_CASE("a piece that finds no room is taken away again") {
  const TemporaryDirectory folder;
  const std::string path = folder.file("a");
  {
    AppendFile file(path);
    file.append("one ", "two ");
    const FileLimit limit(12);
    CHECK(error_of([&] { file.append("th", "ree and more"); }) ==
          path + " can't be written: File too large");
    file.append("four");
    file.close();
  }
  CHECK(read_file(path) == "one two four");
}

TEST_CASE("the last piece can be taken back, once") {
  const TemporaryDirectory folder;
  AppendFile file(folder.file("a"));
  file.append("one");
  file.append("two", "three");
  file.take_back();
  file.take_back();
  file.append("four");
  file.close();
  CHECK(read_file(folder.file("a")) == "onefour");
}

TEST_CASE("a file that can't be made is named") {
  CHECK(error_of([] { AppendFile("/nonexistent/a"); }) ==
        "/nonexistent/a can't be opened: No such file or directory");
}
