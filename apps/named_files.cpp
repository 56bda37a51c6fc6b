#include "apps/named_files.h"

#include <set>
#include <utility>

#include <sys/stat.h>

#include "io/atomic_file.h"
#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {

namespace {

namespace fs = std::filesystem;

/// What a name stands for, at the end of links: two names of one file, hard links too, are equal.
struct Identity {
  std::pair<dev_t, ino_t> file{};  ///< of one that exists
  fs::path place;                  ///< of one that does not
  bool is_special = false;         ///< /dev/null takes all there is

  bool operator==(const Identity& other) const {
    return !is_special && !other.is_special && file == other.file && place == other.place;
  }
};

Identity identity(const fs::path& name) {
  struct stat status {};
  if (::stat(name.c_str(), &status) != 0) return {{}, written_place(name)};
  return {{status.st_dev, status.st_ino}, {}, !S_ISREG(status.st_mode)};
}

[[noreturn]] void refuse(const NamedFile& file, const std::string& why) {
  throw InputError(file.option + " " + clean_text(file.file) + ": " + why + "; " + file.advice + ".");
}

}  // namespace

void refuse_to_overwrite(const std::vector<NamedFile>& files) {
  std::vector<Identity> known;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const NamedFile& file = files[i];
    known.push_back(file.file.empty() ? Identity{{}, {}, true} : identity(file.file));
    for (std::size_t k = 0; k < i; ++k) {
      const NamedFile& other = files[k];
      if (!(file.is_written || other.is_written) || !(known[i] == known[k])) continue;
      if (other.option == kInput) refuse(file, "is the input");
      refuse(file, "is the file of " + other.option + " too");
    }
  }
}

void refuse_to_overwrite(const std::vector<NamedFile>& files, const std::vector<fs::path>& of_scene) {
  std::set<std::pair<dev_t, ino_t>> read;
  for (const fs::path& file : of_scene) {
    struct stat status {};
    if (::stat(file.c_str(), &status) == 0 && S_ISREG(status.st_mode)) read.insert({status.st_dev, status.st_ino});
  }
  for (const NamedFile& file : files) {
    if (!file.is_written || file.file.empty()) continue;
    if (const Identity i = identity(file.file); !i.is_special && i.place.empty() && read.contains(i.file))
      refuse(file, "is a file of the scene");
  }
}

}  // namespace clerestory
