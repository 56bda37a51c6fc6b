#include "io/scene_file/nearest_name.h"

#include <algorithm>
#include <cctype>
#include <vector>

#include "io/some_of.h"

namespace clerestory {
namespace {

char lower(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  // Three rows of the table suffice: the swap of neighbours looks two rows back.
  std::vector<std::size_t> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) above[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = lower(a[i - 1]) == lower(b[j - 1]);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (same ? 0 : 1)});
      if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1])) {
        row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
    before.swap(above);
    above.swap(row);
  }
  return above[b.size()];
}

std::string suggestion(std::string_view mistyped, std::span<const std::string_view> known) {
  const std::string_view typed = mistyped.substr(0, 64);  // a hostile key may be megabytes long
  std::string_view nearest;
  std::size_t fewest = std::string_view::npos;
  for (const std::string_view name : known) {
    const std::size_t edits = edit_distance(typed, name);
    if (edits < fewest) {
      fewest = edits;
      nearest = name;
    }
  }
  // Two letters in five wrong is still a typing error; more is another word.
  if (fewest <= std::max<std::size_t>(1, std::max(typed.size(), nearest.size()) * 2 / 5)) {
    return "did you mean '" + std::string(nearest) + "'?";
  }
  const bool quoted =
      std::ranges::any_of(known, [](std::string_view name) { return name.find_first_of(" ,") != name.npos; });
  const std::string mark = quoted ? "'" : "";
  return "known are " +
         some_of(known, known.size(), [&](std::string_view name) { return mark + std::string(name) + mark; });
}

}  // namespace clerestory
