#pragma once

#include <memory>
#include <string>
#include <string_view>

struct archive;

namespace roundel {

// A new archive, compressed, of the kind that its name says: .tar.gz, .zip and so on. Errors are
// std::runtime_error that names the archive. What is not closed was not finished, and is removed.
class ArchiveWriter {
 public:
  explicit ArchiveWriter(const std::string& path);
  ~ArchiveWriter();
  ArchiveWriter(const ArchiveWriter&) = delete;
  ArchiveWriter& operator=(const ArchiveWriter&) = delete;

  void add(const std::string& name, std::string_view contents);
  void add_file(const std::string& name, const std::string& path);
  void close();

 private:
  struct Free {
    void operator()(archive* opened) const;
  };
  void begin(const std::string& name, std::int64_t size);
  void write(std::string_view data);
  void require(int result) const;

  std::string path_;
  std::unique_ptr<archive, Free> archive_;
  bool open_ = false;
};

}  // namespace roundel
