#include "io/page/page_files.h"

#include <filesystem>
#include <fstream>
#include <iterator>

#include "io/beside_program.h"
#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

namespace fs = std::filesystem;

/// Beside the program, in the build tree as where it is installed; else where the library was installed.
fs::path page_folder() {
  std::error_code error;
  const fs::path beside = beside_program(CLERESTORY_PAGE_FOLDER);
  const fs::path installed = CLERESTORY_INSTALLED_PAGE_FOLDER;
  return !fs::exists(beside / "page.css", error) && fs::exists(installed / "page.css", error) ? installed : beside;
}

std::string content(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

PageFiles read_page_files() {
  const fs::path folder = page_folder();
  PageFiles files{.style = content(folder / "page.css"),
                  .viewer = content(folder / "viewer.js"),
                  .viewer_licence = content(folder / "LICENSE.three.txt"),
                  .why_no_viewer = {}};
  if (files.style.empty())
    throw InputError(text((folder / "page.css").string(), ": is missing or cannot be read; pages take their style ",
                          "from it. Build the program again (cmake --build), or install it again."));
  if (files.viewer.empty() || files.viewer_licence.empty()) {
    files.viewer.clear();
    files.why_no_viewer =
        text("three.js, which draws the 3D view, is not in ", folder.string(),
             "; to install it, run bash apps/install_dependencies.sh in the source folder, then ", "build again");
  }
  return files;
}

}  // namespace clerestory
