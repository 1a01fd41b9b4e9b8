#pragma once

#include <string>
#include <string_view>

namespace roundel {

// Replaces a file as a whole: a temporary file beside it is written, synced and renamed, and the
// folder is synced. After a power loss at any instant the old or the new contents are there.
// Throws std::runtime_error that names the file; the old contents are untouched then.
void write_file_atomically(const std::string& path, std::string_view contents);

// Throws like it if a file of that name can't be written now, without touching it.
void require_writable(const std::string& path);

}  // namespace roundel
