// Texts against the files they speak of: links and names in READMEs, pages and comments.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace clerestory {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = CLERESTORY_SOURCE_DIR;

/// What is ours, relative to the root, of the given extensions.
std::vector<fs::path> own_files(const std::vector<std::string>& extensions) {
  std::vector<fs::path> files;
  const auto take = [&](const fs::directory_entry& entry) {
    const std::string extension = entry.path().extension();
    if (entry.path().string().find("node_modules") != std::string::npos) return;  // what npm brings is not ours
    if (entry.is_regular_file() && std::find(extensions.begin(), extensions.end(), extension) != extensions.end())
      files.push_back(fs::relative(entry.path(), kRoot));
  };
  for (const auto& entry : fs::directory_iterator(kRoot)) take(entry);
  for (const char* folder : {"solver", "meshing", "io", "pipeline", "apps", "tests", "data", "docs", "cmake"})
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) take(entry);
  return files;
}

std::string text_of(const fs::path& file) {
  std::ifstream in(kRoot / file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The first group of each match.
std::vector<std::string> found(const std::string& text, const std::regex& what) {
  std::vector<std::string> all;
  for (std::sregex_iterator m(text.begin(), text.end(), what), end; m != end; ++m) all.push_back((*m)[1]);
  return all;
}

bool is_there(const fs::path& path) {
  return fs::exists(kRoot / path) ||
         fs::exists(kRoot / "cmake" / (path.filename().string() + ".in"));  // made by the build
}

TEST(Docs, EveryRelativeLinkLeadsSomewhere) {
  const std::regex link(R"(\]\(([^)#\s]+)[^)]*\))");
  std::size_t count = 0;
  for (const fs::path& file : own_files({".md"})) {
    for (const std::string& target : found(text_of(file), link)) {
      if (target.find("://") != target.npos) continue;
      EXPECT_TRUE(fs::exists(kRoot / file.parent_path() / target)) << file << " links to " << target;
      ++count;
    }
  }
  EXPECT_GT(count, 50u) << "the pages were not found";
}

TEST(Docs, EveryFileNamedByItsPathIsThere) {
  // In texts, comments and scripts alike. A change log speaks of what was, too.
  const std::regex path(
      R"((?:^|[^A-Za-z0-9_./])((?:solver|meshing|io|pipeline|apps|tests|data|docs|cmake)/[A-Za-z0-9_./-]+\.(?:h|cpp|md|sh|py|json|obj|ies|epw|csv|png|cmake)\b))");
  std::size_t count = 0;
  for (const fs::path& file : own_files({".md", ".h", ".cpp", ".sh", ".py", ".txt", ".cmake"})) {
    if (file == "CHANGELOG.md") continue;
    for (const std::string& name : found(text_of(file), path)) {
      if (name.find("NAME") != name.npos) continue;  // stands for any
      EXPECT_TRUE(is_there(name)) << file << " names " << name;
      ++count;
    }
  }
  EXPECT_GT(count, 1000u) << "the sources were not found";
}

TEST(Docs, EverySourceThatAReadmeNamesIsThere) {
  // Names in backticks: from the README's folder, from the root, or beside the file that was named before in the line.
  const std::regex code("`([^`\n]+)`"), gap("[ ,]+");
  const std::regex source(R"((?:[a-z0-9_.]+/)*[a-z0-9_]+\.(?:h|cpp|py|sh))");
  const std::regex bare(
      R"((?:solver|meshing|io|pipeline|apps|tests|data|docs)/[a-z0-9_/.]*)");  // a folder, or without .h
  std::size_t count = 0;
  for (const fs::path& file : own_files({".md"})) {
    if (file == "CHANGELOG.md") continue;
    std::istringstream text(text_of(file));
    for (std::string line; std::getline(text, line);) {
      fs::path beside;
      for (const std::string& words : found(line, code)) {
        for (std::sregex_token_iterator word(words.begin(), words.end(), gap, -1), end; word != end; ++word) {
          const std::string name = *word;
          if (std::regex_match(name, source)) {
            const fs::path here = file.parent_path() / name;
            EXPECT_TRUE(is_there(here) || is_there(name) || is_there(beside / name)) << file << " names " << name;
            if (is_there(here)) beside = here.parent_path();
            if (is_there(name)) beside = fs::path(name).parent_path();
            ++count;
          } else if (std::regex_match(name, bare)) {
            EXPECT_TRUE(is_there(name) || is_there(name + ".h") || fs::exists(kRoot / file.parent_path() / name))
                << file << " names " << name;
            ++count;
          }
        }
      }
    }
  }
  EXPECT_GT(count, 100u) << "the READMEs were not found";
}

TEST(Docs, EveryFolderOfSourcesHasAReadmeThatOpensWithAPicture) {
  std::vector<fs::path> folders = {"meshing", "io", "pipeline", "apps", "tests", "data", "docs", "solver"};
  for (const auto& room : fs::directory_iterator(kRoot / "solver"))
    if (room.is_directory()) folders.push_back("solver" / room.path().filename());
  for (const fs::path& folder : folders) {
    const std::string text = text_of(folder / "README.md");
    ASSERT_FALSE(text.empty()) << folder;
    EXPECT_TRUE(text.starts_with("# ")) << folder << ": is it still text?";
    const std::size_t picture = std::min(text.find("```"), text.find("!["));
    EXPECT_LT(picture, 900u) << folder;
  }
}

TEST(Docs, PicturesFitAPage) {
  std::size_t count = 0;
  for (const fs::path& file : own_files({".png"})) {
    const std::string bytes = text_of(file);
    ASSERT_GT(bytes.size(), 24u) << file;
    EXPECT_LE(bytes.size(), 150'000u) << file;
    const auto byte = [&](std::size_t i) { return static_cast<unsigned>(static_cast<unsigned char>(bytes[i])); };
    EXPECT_LE(byte(16) << 24 | byte(17) << 16 | byte(18) << 8 | byte(19), 900u) << file;  // width, of the IHDR chunk
    ++count;
  }
  EXPECT_GT(count, 5u) << "the pictures were not found";
}

}  // namespace
}  // namespace clerestory
