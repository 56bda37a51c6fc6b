#pragma once
// Files that appear whole or not at all, one alone or several together.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <string>
#include <string_view>

namespace clerestory {

/// A file under construction: written beside its destination under a name nobody can guess, renamed by commit(),
/// removed when destroyed before that. It takes the mode of the file it replaces, and its owner and group where it
/// may; a group that it cannot have keeps no rights by another's name. Links are followed, so that the file they point
/// to is replaced and not the link. A destination that is no regular file
/// (/dev/null, /dev/stdout, a pipe) gets its bytes in place, all of them at commit().
///
/// What killed runs left beside the same destination is removed; what a run that lives is writing stays: it holds a
/// lock on it.
class AtomicFile {
 public:
  /// throws  InputError when no file can be made there: missing or unwritable directory, a directory in the way.
  explicit AtomicFile(const std::filesystem::path& destination);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  /// Adds to the file.
  /// throws  InputError when the disk is full or a limit of the system is reached.
  void write(std::string_view bytes);
  /// The same at a place of the file, for writers that go back.
  void write_at(std::uint64_t place, std::string_view bytes);
  /// The same, at the end, for what a library writes through a name of its own: opened with it, until commit().
  std::filesystem::path name_to_open() const;
  const std::filesystem::path& destination() const { return asked_; }
  /// throws  InputError as write() does; the old file is untouched then.
  void commit();
  /// throws  InputError that names the file and says why it cannot be written.
  [[noreturn]] void refuse(const std::string& why) const;
  /// The descriptor, to write on after commit(); the caller closes it.
  int release();

 private:
  friend class Outputs;
  void make_temporary();
  void remove_temporary() noexcept;
  /// All bytes are on the disk, and those of special files where they belong.
  void finish();
  /// The new file gets the name. Where there was an old one it has the temporary name then, so that undo() can bring it
  /// back; drop_old() removes it.
  void replace();
  void undo() noexcept;
  void drop_old() noexcept;

  std::filesystem::path asked_, destination_, temporary_;
  bool in_place_ = false;
  int descriptor_ = -1;  ///< of the temporary; of a file in memory when in place
  int device_ = -1;      ///< of what is written in place
  int slot_ = -1;        ///< where signal handlers find the temporary
  enum class Named { no, beside_old, linked_old, alone, over_old } named_ = Named::no;  ///< what replace() did
};

/// The files of one run.
class Outputs {
 public:
  /// A file that is part of them. The reference stays valid.
  AtomicFile& open(const std::filesystem::path& destination) { return files_.emplace_back(destination); }
  /// Renames all of them, once all are whole on the disk.
  /// throws  InputError that names the file and why; all old files are as they were then. Only where a file system
  ///         knows neither an exchange of names nor hard links (FAT) do those stay replaced that were before it.
  void commit();

 private:
  std::deque<AtomicFile> files_;
};

/// The file that would be written for `destination`, at the end of all links.
std::filesystem::path written_place(const std::filesystem::path& destination);

/// throws  InputError when `destination` could not be written; call it before a long computation.
void check_writable(const std::filesystem::path& destination);

/// Raises the limit of open files of this process (`ulimit -n`) where so many more do not fit: Outputs are open
/// together. what    "--times", for messages. throws  InputError when it cannot be raised that far; call it before a
/// long computation.
void require_open_files(std::size_t count, const std::string& what);

/// throws  InputError when the disk is full or the place is not writable; the old file is untouched then.
void write_file(const std::filesystem::path& destination, std::string_view content);

/// Writes to an open file. returns why not, as people know it; nothing when it went well, or when nobody reads any
/// more.
std::string write_to(int descriptor, std::string_view bytes);

/// Removes all files of this process that are not committed, for a signal handler that is about to end it: takes no
/// lock and no memory. False while files are being renamed, a matter of microseconds: the process should not end now.
bool remove_temporaries() noexcept;

}  // namespace clerestory
