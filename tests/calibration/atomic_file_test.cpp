#include "calibration/atomic_file.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <iterator>

#include "tests/error_of.hpp"
#include "tests/temporary_directory.hpp"

using namespace roundel;

TEST_CASE("a file is replaced as a whole and nothing else is left in its folder") {
  const TemporaryDirectory folder;
  const std::string path = folder.write("a.yaml", "a long old text");
  write_file_atomically(path, "new");
  CHECK(read_file(path) == "new");
  CHECK(std::distance(std::filesystem::directory_iterator(folder.file("")), {}) == 1);
}

TEST_CASE("a file that can't be written is an error and leaves no temporary file") {
  const TemporaryDirectory folder;
  CHECK(error_of([&] {
          write_file_atomically(folder.file("none/a.yaml"), "x");
        }).starts_with(folder.file("none/a.yaml") + ": can't be written"));
  std::filesystem::create_directory(folder.file("taken"));
  CHECK(error_of([&] {
          write_file_atomically(folder.file("taken"), "x");
        }).starts_with(folder.file("taken") + ": can't be replaced"));
  CHECK(std::distance(std::filesystem::directory_iterator(folder.file("")), {}) == 1);
}
