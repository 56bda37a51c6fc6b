// The #include lines: who may include whom, and one door for each library.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace clerestory {
namespace {

namespace fs = std::filesystem;

struct Include {
  std::string file;    ///< relative to the root
  std::string header;  ///< as written
  bool own = false;    ///< in quotes
};

/// Sources and headers, relative to the root.
std::vector<std::string> own_files() {
  const fs::path root = CLERESTORY_SOURCE_DIR;
  std::vector<std::string> files;
  for (const char* folder : {"solver", "meshing", "io", "pipeline", "apps"})
    for (const auto& entry : fs::recursive_directory_iterator(root / folder))
      if (entry.path().extension() == ".h" || entry.path().extension() == ".cpp")
        files.push_back(fs::relative(entry.path(), root).generic_string());
  return files;
}

std::vector<Include> all_includes() {
  const std::regex line_of_include(R"re(\s*#\s*include\s*([<"])([^>"]+)[>"].*)re");
  std::vector<Include> includes;
  for (const std::string& file : own_files()) {
    std::ifstream in(fs::path(CLERESTORY_SOURCE_DIR) / file);
    for (std::string line; std::getline(in, line);) {
      std::smatch part;
      if (std::regex_match(line, part, line_of_include)) includes.push_back({file, part[2], part[1] == "\""});
    }
  }
  return includes;
}

bool starts_with_any(const std::string& text, const std::vector<std::string>& beginnings) {
  for (const std::string& b : beginnings)
    if (text.starts_with(b)) return true;
  return false;
}

/// The rooms of solver/, lowest floor first: a room may include itself and the floors below it, no neighbour.
const std::vector<std::vector<std::string>> kFloors = {
    {"model"},        {"geometry"},  {"sampling", "visibility"},
    {"form_factors"}, {"lights"},    {"openings"},
    {"illumination"}, {"particles"}, {"spaces", "gather", "paths", "view"},
    {"hierarchy"},    {"methods"},   {"evaluate", "annual"},
    {"dimming"},      {"run"},
};

/// Folders whose headers a file may include.
std::vector<std::string> allowed_layers(const std::string& file) {
  if (file.starts_with("solver/")) {
    std::vector<std::string> allowed;
    for (const auto& floor : kFloors) {
      for (const std::string& room : floor)
        if (const std::string own = "solver/" + room + "/"; file.starts_with(own)) {
          allowed.push_back(own);
          return allowed;
        }
      for (const std::string& room : floor) allowed.push_back("solver/" + room + "/");
    }
    return {};  // a file in no room
  }
  if (file.starts_with("meshing/")) return {"meshing/", "solver/model/"};
  if (file.starts_with("io/")) return {"io/", "solver/model/"};
  if (file.starts_with("pipeline/")) return {"pipeline/", "io/", "meshing/", "solver/"};
  return {"apps/", "pipeline/", "io/", "meshing/", "solver/"};
}

struct Library {
  std::string name;
  std::regex header;
  std::vector<std::string> doors;  ///< files that may include it begin with one of these
  bool in_headers = false;         ///< may our headers show it
};

const std::vector<Library>& libraries() {
  static const std::vector<Library> all = {
      {"Embree", std::regex("embree.*"), {"solver/visibility/"}},
      {"CGAL", std::regex("CGAL/.*"), {"meshing/"}, true},  // headers of kernels inside meshing/ only
      {"OpenMesh", std::regex("OpenMesh/.*"), {"meshing/", "solver/hierarchy/element_mesh"}, true},  // as CGAL
      {"stb", std::regex("stb/.*"), {"meshing/atlas/"}},
      {"VTK", std::regex("vtk.*"), {"io/"}, true},  // what our .vtp files share, inside io/ only
      {"Assimp", std::regex("assimp/.*"), {"io/"}},
      {"OpenImageIO", std::regex("OpenImageIO/.*"), {"io/"}},
      {"Clp", std::regex("coin/.*"), {"solver/dimming/linear_programme.cpp"}},
      {"HDF5", std::regex("hdf5\\.h"), {"io/annual/hdf5_module.cpp"}},
      {"JSON", std::regex("nlohmann/.*"), {"io/", "apps/"}, true},
      {"TBB", std::regex("(tbb|oneapi)/.*"), {"solver/model/parallel.cpp"}},
      {"CLI11", std::regex("CLI/.*"), {"apps/"}},
      {"ThreadSanitizer", std::regex("sanitizer/tsan_interface\\.h"), {"solver/model/parallel.cpp"}},
  };
  return all;
}

bool is_standard(const std::string& header) {
  // The C and C++ libraries have no folder but sys/, and POSIX is used in apps/ and io/.
  static const std::regex standard("[a-z_0-9]+|[a-z_0-9]+\\.h|sys/[a-z]+\\.h");
  return std::regex_match(header, standard);
}

TEST(Layers, OwnHeadersAreIncludedFromTheRootAndDownwardsOnly) {
  const auto includes = all_includes();
  ASSERT_GT(includes.size(), 200u) << "the sources were not found";
  for (const Include& i : includes) {
    if (!i.own) continue;
    EXPECT_TRUE(starts_with_any(i.header, allowed_layers(i.file))) << i.file << " includes " << i.header;
  }
}

TEST(Layers, EveryLibraryIsIncludedAtItsDoorOnly) {
  for (const Include& i : all_includes()) {
    if (i.own) continue;
    const auto& all = libraries();
    const auto library =
        std::find_if(all.begin(), all.end(), [&](const Library& l) { return std::regex_match(i.header, l.header); });
    if (library == all.end() && is_standard(i.header)) continue;
    ASSERT_NE(library, all.end()) << i.file << " includes <" << i.header << ">, which has no door";
    EXPECT_TRUE(starts_with_any(i.file, library->doors)) << i.file << " includes " << library->name;
    EXPECT_TRUE(library->in_headers || !i.file.ends_with(".h")) << i.file << " shows " << library->name;
  }
}

TEST(Layers, HeadersForUsersOfTheLibraryShowNoLibrary) {
  // They must compile without CGAL, VTK, JSON and the rest.
  const std::vector<std::string> doors = {
      "solver/",           "pipeline/",         "meshing/build_patches.h", "meshing/make_lightmap.h",
      "io/read_scene.h",   "io/read_sensors.h", "io/formats/epw.h",        "io/formats/weather_year.h",
      "io/write_result.h", "io/run_report.h",   "io/write_sensors.h"};
  for (const Include& i : all_includes()) {
    if (i.own || !i.file.ends_with(".h") || !starts_with_any(i.file, doors)) continue;
    EXPECT_TRUE(is_standard(i.header)) << i.file << " includes <" << i.header << ">";
  }
}

TEST(Names, NoTwoHeadersShareOne) {
  std::map<std::string, std::string> by_name;
  for (const std::string& file : own_files()) {
    if (!file.ends_with(".h")) continue;
    const auto [other, is_new] = by_name.try_emplace(fs::path(file).filename(), file);
    EXPECT_TRUE(is_new) << file << " and " << other->second;
  }
}

TEST(Names, NoTwoTypesInHeadersShareOne) {
  // Two definitions of one name in a namespace break the one-definition rule, and no compiler tells.
  const std::regex definition(R"((?:struct|class|enum class|enum) (?:\[\[.*\]\] )?([A-Z][A-Za-z0-9]*)\b[^;]*\{.*)");
  std::map<std::string, std::string> by_name;
  for (const std::string& file : own_files()) {
    if (!file.ends_with(".h")) continue;
    std::ifstream in(fs::path(CLERESTORY_SOURCE_DIR) / file);
    for (std::string line; std::getline(in, line);) {
      std::smatch part;
      if (!std::regex_match(line, part, definition)) continue;
      const auto [other, is_new] = by_name.try_emplace(part[1], file);
      EXPECT_TRUE(is_new) << part[1] << " in " << file << " and " << other->second;
    }
  }
  EXPECT_GT(by_name.size(), 100u) << "the headers were not found";
}

TEST(Materials, AreAskedWhatTheyDoAndNotOfWhatKindTheyAre) {
  for (const std::string& file : own_files()) {
    if (file.starts_with("io/") || file == "solver/model/material.h") continue;  // readers say which kind it is
    std::ifstream in(fs::path(CLERESTORY_SOURCE_DIR) / file);
    for (std::string line; std::getline(in, line);)
      EXPECT_TRUE(line.find("MaterialKind::") == line.npos || file == "apps/commands/formfactors.cpp")
          << file << ": " << line;
  }
}

TEST(Streams, EachHasANumberOfItsOwn) {
  std::ifstream in(fs::path(CLERESTORY_SOURCE_DIR) / "solver/model/streams.h");
  const std::regex enumerator(R"(\s*k[A-Za-z]+ = (0x[0-9a-f]+),.*)");
  std::set<std::string> numbers;
  std::size_t count = 0;
  for (std::string line; std::getline(in, line);) {
    std::smatch part;
    if (!std::regex_match(line, part, enumerator)) continue;
    EXPECT_TRUE(numbers.insert(part[1]).second) << part[1] << " is used twice";
    ++count;
  }
  EXPECT_GT(count, 20u) << "the list was not found";
}

}  // namespace
}  // namespace clerestory
