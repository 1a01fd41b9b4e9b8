#include "tools/archive_writer.hpp"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "daemon/file_pointer.hpp"

namespace roundel {
namespace {

constexpr int kMode = 0644;

}  // namespace

void ArchiveWriter::Free::operator()(archive* opened) const {
  ::archive_write_free(opened);
}

ArchiveWriter::ArchiveWriter(const std::string& path)
    : path_(path), archive_(::archive_write_new()) {
  if (!archive_) throw std::runtime_error("libarchive can't be used");
  require(::archive_write_set_format_filter_by_ext(archive_.get(), path.c_str()));
  require(::archive_write_open_filename(archive_.get(), path.c_str()));
  open_ = true;
}

ArchiveWriter::~ArchiveWriter() {
  archive_.reset();
  std::error_code error;
  if (open_ && std::filesystem::is_regular_file(path_, error))
    std::filesystem::remove(path_, error);
}

void ArchiveWriter::require(int result) const {
  if (result >= ARCHIVE_WARN) return;
  const char* const text = ::archive_error_string(archive_.get());
  std::string reason = text != nullptr ? text : "no reason is known";
  // libarchive's own words do not tell that the disk is full.
  const int number = ::archive_errno(archive_.get());
  if (number > 0) reason += fmt::format(" ({})", std::strerror(number));
  throw std::runtime_error(fmt::format("{} can't be written: {}", path_, reason));
}

void ArchiveWriter::begin(const std::string& name, std::int64_t size) {
  const std::unique_ptr<archive_entry, void (*)(archive_entry*)> entry(::archive_entry_new(),
                                                                       ::archive_entry_free);
  ::archive_entry_set_pathname(entry.get(), name.c_str());
  ::archive_entry_set_size(entry.get(), size);
  ::archive_entry_set_filetype(entry.get(), AE_IFREG);
  ::archive_entry_set_perm(entry.get(), kMode);
  ::archive_entry_set_mtime(entry.get(), std::time(nullptr), 0);
  require(::archive_write_header(archive_.get(), entry.get()));
}

void ArchiveWriter::write(std::string_view data) {
  const la_ssize_t written = ::archive_write_data(archive_.get(), data.data(), data.size());
  require(written < 0 ? static_cast<int>(written) : ARCHIVE_OK);
}

void ArchiveWriter::add(const std::string& name, std::string_view contents) {
  begin(name, static_cast<std::int64_t>(contents.size()));
  write(contents);
}

void ArchiveWriter::add_file(const std::string& name, const std::string& path) {
  const FilePointer file(std::fopen(path.c_str(), "rbe"));
  if (!file)
    throw std::runtime_error(fmt::format("{} can't be opened: {}", path, std::strerror(errno)));
  begin(name, static_cast<std::int64_t>(std::filesystem::file_size(path)));
  std::vector<char> block(std::size_t{1} << 20);
  while (const std::size_t size = std::fread(block.data(), 1, block.size(), file.get())) {
    write({block.data(), size});
  }
}

void ArchiveWriter::close() {
  require(::archive_write_close(archive_.get()));
  open_ = false;
}

}  // namespace roundel
