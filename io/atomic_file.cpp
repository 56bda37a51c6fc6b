#include "io/atomic_file.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/random.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMark = ".tmp-";
constexpr std::size_t kRandomDigits = 16, kLongestName = 255;

/// Reasons as people know them.
std::string reason(int error) {
  switch (error) {
    case ENOSPC:
      return "the disk is full";
    case EDQUOT:
      return "the disk quota is used up";
    case EFBIG:
      return "it grows beyond the largest file that is allowed (ulimit -f)";
    case EMFILE:
      return "more files are open at once than is allowed (ulimit -Hn)";
    default:
      return std::strerror(error);
  }
}

// The only state of io that outlives a call: a signal handler can reach nothing else.
std::array<std::atomic<char*>, 1 << 14> temporaries{};
std::atomic<int> renames{0};
static_assert(std::atomic<char*>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

int note_temporary(const fs::path& file) {
  char* name = ::strdup(file.c_str());
  for (std::size_t i = 0; name && i < temporaries.size(); ++i) {
    char* empty = nullptr;
    if (temporaries[i].compare_exchange_strong(empty, name)) return static_cast<int>(i);
  }
  std::free(name);
  return -1;  // more than that at once: a killed run leaves them to the next one
}

void forget_temporary(int slot) {
  if (slot >= 0) std::free(temporaries[static_cast<std::size_t>(slot)].exchange(nullptr));
}

/// While one lives, nothing ends the process in the middle of renaming.
struct Renaming {
  Renaming() { ++renames; }
  ~Renaming() { --renames; }
  Renaming(const Renaming&) = delete;
  Renaming& operator=(const Renaming&) = delete;
};

/// The number N of a link to /proc/PID/fd/N: a descriptor that is open already; -1: none.
int open_descriptor(const fs::path& file) {
  const std::string name = file.string();
  if (!name.starts_with("/proc/") && !name.starts_with("/dev/fd/")) return -1;
  const std::string own = "/proc/" + std::to_string(::getpid()) + "/fd/";
  for (const std::string& folder : {own, std::string("/proc/self/fd/"), std::string("/dev/fd/")}) {
    if (!name.starts_with(folder)) continue;
    const std::string digits = name.substr(folder.size());
    if (digits.empty() || digits.size() > 9 || digits.find_first_not_of("0123456789") != digits.npos) return -1;
    return std::stoi(digits);
  }
  return -1;
}

/// The end of the links that start at `file`, or a link to an open descriptor on the way there.
fs::path end_of_links(fs::path file) {
  std::error_code error;
  for (int k = 0; k < 40 && open_descriptor(file) < 0 && fs::is_symlink(file, error); ++k) {
    const fs::path target = fs::read_symlink(file, error);
    if (error) break;
    file = file.parent_path() / target;  // an absolute target stands alone
  }
  return file;
}

/// What temporaries of this file start with. A name that is long already is cut.
std::string stem_of_temporaries(const fs::path& file) {
  return file.filename().string().substr(0, kLongestName - kMark.size() - kRandomDigits) + std::string(kMark);
}

std::string random_digits() {
  std::array<unsigned char, kRandomDigits / 2> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now);  // O_EXCL keeps a name that is guessed harmless
    std::memcpy(bytes.data(), &now.tv_nsec, std::min(sizeof now.tv_nsec, bytes.size()));
  }
  std::string digits;
  for (const unsigned char byte : bytes)
    digits += "0123456789abcdef"[byte >> 4], digits += "0123456789abcdef"[byte & 15];
  return digits;
}

bool is_temporary(const std::string& name, const std::string& stem) {
  return name.size() == stem.size() + kRandomDigits && name.starts_with(stem) &&
         name.find_first_not_of("0123456789abcdef", stem.size()) == name.npos;
}

/// Removes what dead runs left: temporaries of this file that nobody holds a lock on.
void remove_leftovers(const fs::path& folder, const std::string& stem) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (!is_temporary(entry->path().filename().string(), stem)) continue;
    const int found = ::open(entry->path().c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (found < 0) continue;
    struct stat status {};
    const bool is_ours = ::fstat(found, &status) == 0 && S_ISREG(status.st_mode) && status.st_uid == ::geteuid();
    if (is_ours && ::flock(found, LOCK_EX | LOCK_NB) == 0) ::unlink(entry->path().c_str());
    ::close(found);
  }
}

/// Whether the open file is still the one of this name.
bool is_at(int descriptor, const fs::path& name) {
  struct stat open_file {
  }, named{};
  return ::fstat(descriptor, &open_file) == 0 && ::lstat(name.c_str(), &named) == 0 &&
         open_file.st_dev == named.st_dev && open_file.st_ino == named.st_ino;
}

/// Owner, group and mode of the file that is replaced. Only root may give a file away; a group that one is in can be
/// kept.
void keep_mode(int descriptor, const struct stat& old) {
  struct stat made {};
  if (::fstat(descriptor, &made) != 0) return;
  constexpr auto kSame = static_cast<uid_t>(-1);
  const bool is_same = made.st_uid == old.st_uid && made.st_gid == old.st_gid;
  const bool owner_kept = is_same || ::fchown(descriptor, old.st_uid, old.st_gid) == 0;
  const bool group_kept = owner_kept || made.st_gid == old.st_gid || ::fchown(descriptor, kSame, old.st_gid) == 0;
  mode_t mode = old.st_mode & (owner_kept ? 07777u : 0777u);
  if (!group_kept) mode = (mode & 0707u) | (mode & 07u) << 3;  // a group that was among the others stays there
  ::fchmod(descriptor, mode);
}

/// 0, or why not all bytes were taken.
int write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t taken = ::write(descriptor, bytes.data(), bytes.size());
    if (taken < 0 && errno == EINTR) continue;
    if (taken < 0 && errno == EAGAIN) {  // a pipe that does not wait by itself
      pollfd ready{descriptor, POLLOUT, 0};
      ::poll(&ready, 1, -1);
      continue;
    }
    if (taken <= 0) return taken < 0 ? errno : ENOSPC;
    bytes.remove_prefix(static_cast<std::size_t>(taken));
  }
  return 0;
}

int copy_all(int from, int to) {
  if (::lseek(from, 0, SEEK_SET) < 0) return errno;
  std::string block(1 << 16, '\0');
  for (;;) {
    const ssize_t n = ::read(from, block.data(), block.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return n < 0 ? errno : 0;
    if (const int error = write_all(to, std::string_view(block).substr(0, static_cast<std::size_t>(n)))) return error;
  }
}

}  // namespace

std::filesystem::path written_place(const fs::path& destination) {
  std::error_code error;
  const fs::path end = end_of_links(destination);
  const fs::path place = fs::weakly_canonical(fs::absolute(end, error), error);
  return place.empty() ? end : place;
}

AtomicFile::AtomicFile(const fs::path& destination) : asked_(destination), destination_(end_of_links(destination)) {
  if (destination_.empty()) refuse("the name is empty");
  const int already_open = open_descriptor(destination_);
  struct stat old {};
  const bool exists = (already_open >= 0 ? ::fstat(already_open, &old) : ::stat(destination_.c_str(), &old)) == 0;
  if (!exists && (already_open >= 0 || errno != ENOENT)) refuse(std::strerror(errno));
  if (exists && S_ISDIR(old.st_mode)) refuse("it is a directory");
  if (exists && (S_ISBLK(old.st_mode) || S_ISSOCK(old.st_mode))) refuse("it is a disk or a socket");
  if (exists && already_open < 0 && ::access(destination_.c_str(), W_OK) != 0) refuse(std::strerror(errno));
  in_place_ = already_open >= 0 || (exists && !S_ISREG(old.st_mode));
  if (in_place_) {
    if (already_open >= 0 && (device_ = ::fcntl(already_open, F_DUPFD_CLOEXEC, 3)) < 0) refuse(std::strerror(errno));
    descriptor_ = ::memfd_create("clerestory", MFD_CLOEXEC);
    if (descriptor_ < 0) refuse(std::strerror(errno));
  } else {
    make_temporary();
    if (exists) keep_mode(descriptor_, old);
  }
}

void AtomicFile::make_temporary() {
  std::error_code error;
  const fs::path folder = destination_.has_parent_path() ? destination_.parent_path() : fs::path(".");
  if (!fs::exists(folder, error)) refuse("the directory " + clean_text(folder.string()) + " does not exist");
  const std::string stem = stem_of_temporaries(destination_);
  remove_leftovers(folder, stem);
  // Making the file is the only sure test: permissions, read-only and full file systems all show here.
  for (int attempt = 0; attempt < 16; ++attempt) {
    const fs::path name = folder / (stem + random_digits());
    const int made = ::open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (made < 0 && errno == EEXIST) continue;
    if (made < 0) refuse(reason(errno));
    temporary_ = name, descriptor_ = made, slot_ = note_temporary(name);
    // A run that looks for leftovers may have come between; then the file is gone, or about to be.
    const bool locked = ::flock(made, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
    if (locked && is_at(made, name)) return;
    remove_temporary();
  }
  refuse("no temporary file can be made beside it");
}

void AtomicFile::remove_temporary() noexcept {
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  temporary_.clear();
  forget_temporary(std::exchange(slot_, -1));
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
}

AtomicFile::~AtomicFile() {
  remove_temporary();
  if (device_ >= 0) ::close(device_);
}

void AtomicFile::refuse(const std::string& why) const {
  throw InputError(
      text(clean_text(asked_.string()), ": cannot be written: ", why, "; choose another place for this output."));
}

void AtomicFile::write(std::string_view bytes) {
  if (const int error = write_all(descriptor_, bytes)) refuse(reason(error));
}

void AtomicFile::write_at(std::uint64_t place, std::string_view bytes) {
  if (::lseek(descriptor_, static_cast<off_t>(place), SEEK_SET) < 0) refuse(reason(errno));
  write(bytes);
}

void AtomicFile::finish() {
  if (in_place_) {
    if (device_ < 0) device_ = ::open(destination_.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
    if (device_ < 0) refuse(std::strerror(errno));
    if (const int error = copy_all(descriptor_, device_)) refuse(reason(error));
    return;
  }
  if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS && errno != ENOSYS) refuse(reason(errno));
  // Some file systems tell at closing that they could not keep the bytes. The lock stays with the other descriptor.
  const int copy = ::fcntl(descriptor_, F_DUPFD_CLOEXEC, 3);
  if (copy >= 0 && ::close(copy) != 0 && errno != EINTR) refuse(reason(errno));
}

void AtomicFile::replace() {
  if (in_place_) return;
  std::error_code error;
  if (fs::is_directory(destination_, error)) refuse("it is a directory");
  const char *from = temporary_.c_str(), *to = destination_.c_str();
#ifdef RENAME_EXCHANGE
  if (::renameat2(AT_FDCWD, from, AT_FDCWD, to, RENAME_EXCHANGE) == 0) {
    named_ = Named::beside_old;
    return;
  }
#endif
  // NFS and others exchange nothing: there the old file gets a second name, where the file system knows such.
  const bool over_old = fs::exists(destination_, error);
  const fs::path spare = fs::path(temporary_).replace_filename(stem_of_temporaries(destination_) + random_digits());
  const bool is_kept = over_old && ::link(to, spare.c_str()) == 0;
  if (::rename(from, to) != 0) {
    const int why = errno;
    if (is_kept) ::unlink(spare.c_str());
    refuse(reason(why));
  }
  named_ = is_kept ? Named::linked_old : over_old ? Named::over_old : Named::alone;
  forget_temporary(std::exchange(slot_, is_kept ? note_temporary(spare) : -1));
  temporary_ = is_kept ? spare : fs::path();
}

void AtomicFile::undo() noexcept {
#ifdef RENAME_EXCHANGE
  if (named_ == Named::beside_old)
    ::renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, destination_.c_str(), RENAME_EXCHANGE);
#endif
  if (named_ == Named::linked_old) ::rename(temporary_.c_str(), destination_.c_str());
  if (named_ == Named::alone) ::unlink(destination_.c_str());
}

void AtomicFile::drop_old() noexcept {
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  temporary_.clear();
  forget_temporary(std::exchange(slot_, -1));
}

void AtomicFile::commit() {
  finish();
  const Renaming no_end_now;
  replace();
  drop_old();
}

fs::path AtomicFile::name_to_open() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

int AtomicFile::release() { return std::exchange(in_place_ ? device_ : descriptor_, -1); }

void Outputs::commit() {
  // Special files last: what went into a pipe cannot be taken back.
  for (const bool in_place : {false, true})
    for (AtomicFile& file : files_)
      if (file.in_place_ == in_place) file.finish();
  const Renaming no_end_now;
  try {
    for (AtomicFile& file : files_) file.replace();
  } catch (...) {
    for (AtomicFile& file : files_) file.undo();
    throw;
  }
  files_.clear();
}

void check_writable(const fs::path& destination) { AtomicFile{destination}; }

void require_open_files(std::size_t count, const std::string& what) {
  constexpr rlim_t kOthers = 32;  // standard streams, the log, files of libraries
  const rlim_t needed = static_cast<rlim_t>(count) + kOthers;
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= needed) return;
  limit.rlim_cur = needed;
  if (limit.rlim_max < needed || ::setrlimit(RLIMIT_NOFILE, &limit) != 0)
    throw InputError(text(what, ": ", count, " files are written together, and ", limit.rlim_max,
                          " may be open at once (ulimit -n); ask for fewer, or raise the limit"));
}

void write_file(const fs::path& destination, std::string_view content) {
  AtomicFile file(destination);
  file.write(content);
  file.commit();
}

std::string write_to(int descriptor, std::string_view bytes) {
  const int error = write_all(descriptor, bytes);
  return error == 0 || error == EPIPE ? std::string() : reason(error);
}

bool remove_temporaries() noexcept {
  if (renames.load() > 0) return false;
  for (auto& slot : temporaries)
    if (const char* name = slot.exchange(nullptr)) ::unlink(name);
  return true;
}

}  // namespace clerestory
