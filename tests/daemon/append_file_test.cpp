#include "daemon/append_file.hpp"

#include <doctest/doctest.h>

#include "tests/error_of.hpp"
#include "tests/file_size_limit.hpp"
#include "tests/temporary_directory.hpp"

using namespace roundel;

TEST_CASE("a piece that finds no room is taken away again") {
  const TemporaryDirectory folder;
  const std::string path = folder.file("a");
  {
    AppendFile file(path);
    file.append("one ", "two ");
    const FileSizeLimit limit(12);
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
