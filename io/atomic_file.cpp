#include "io/atomic_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>

#include <fcntl.h>
#include <unistd.h>

#include "solver/model/error.h"

namespace clerestory {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& file, const std::string& why) {
  throw InputError(file.string() + ": cannot be written: " + why + "; choose another place for this output.");
}

/// Links are followed, so that the file they point to is replaced and not the link.
fs::path resolved(const fs::path& file) {
  std::error_code error;
  const fs::path target = fs::is_symlink(file, error) ? fs::weakly_canonical(file, error) : file;
  return target.empty() ? file : target;
}

bool is_special(const fs::path& file) {
  std::error_code error;
  const auto status = fs::status(file, error);
  return fs::exists(status) && !fs::is_regular_file(status);
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& destination) : destination_(resolved(destination)) {
  std::error_code error;
  if (destination_.empty()) refuse(destination, "the name is empty");
  if (fs::is_directory(destination_, error)) refuse(destination, "it is a directory");
  if (is_special(destination_)) {
    temporary_ = destination_;
    return;
  }
  const fs::path folder = destination_.has_parent_path() ? destination_.parent_path() : fs::path(".");
  if (!fs::exists(folder, error)) refuse(destination, "the directory " + folder.string() + " does not exist");
  temporary_ = destination_;
  temporary_ += ".tmp-" + std::to_string(::getpid());
  // Making the file is the only sure test: permissions, read-only and full file systems all show here.
  const int descriptor = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) refuse(destination, std::strerror(errno));
  ::close(descriptor);
}

AtomicFile::~AtomicFile() {
  std::error_code ignored;
  if (!temporary_.empty() && temporary_ != destination_) fs::remove(temporary_, ignored);
}

void AtomicFile::commit() {
  if (temporary_ == destination_) return;
  std::error_code error;
  fs::rename(temporary_, destination_, error);
  if (error) refuse(destination_, error.message());
  temporary_.clear();
}

void check_writable(const fs::path& destination) { AtomicFile{destination}; }

void write_file(const fs::path& destination, std::string_view content) {
  AtomicFile file(destination);
  std::ofstream out(file.path(), std::ios::binary);
  out.write(content.data(), static_cast<std::streamsize>(content.size()));
  out.close();
  if (!out) refuse(destination, "the disk is full or went away");
  file.commit();
}

}  // namespace clerestory
