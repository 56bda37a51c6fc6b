#pragma once
// Files that appear whole or not at all.

#include <filesystem>
#include <string_view>

namespace clerestory {

/// A file under construction: written beside its destination under a temporary name, renamed by commit(), removed when
/// destroyed before that. A destination that is no regular file (/dev/null, a pipe) is written in place.
class AtomicFile {
 public:
  /// throws  InputError when no file can be made there: missing or unwritable directory, a directory in the way.
  explicit AtomicFile(const std::filesystem::path& destination);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Where to write before commit().
  const std::filesystem::path& path() const { return temporary_; }
  void commit();

 private:
  std::filesystem::path destination_, temporary_;
};

/// throws  InputError when `destination` could not be written; call it before a long computation.
void check_writable(const std::filesystem::path& destination);

/// throws  InputError when the disk is full or the place is not writable; the old file is untouched then.
void write_file(const std::filesystem::path& destination, std::string_view content);

}  // namespace clerestory
