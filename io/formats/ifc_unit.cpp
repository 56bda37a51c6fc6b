#include "io/formats/ifc_unit.h"

#include <array>
#include <cctype>
#include <string>
#include <vector>

#include "io/text.h"

namespace clerestory {
namespace {

constexpr std::size_t kMaxUnits = 64;  // a project has a dozen

bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

/// "IFCSIUNIT(*,.LENGTHUNIT.,.MILLI.,.METRE.)" of "#5= IFCSIUNIT(*, .LENGTHUNIT., ...);": blanks and texts left out.
std::string entity_at(std::string_view file, std::size_t begin) {
  std::string entity;
  bool quoted = false;
  for (std::size_t i = begin; i < file.size() && entity.size() < 4096; ++i) {
    if (file[i] == '\'') quoted = !quoted;
    if (quoted || file[i] == '\'' || is_space(file[i])) continue;
    if (file[i] == ';') break;
    entity += static_cast<char>(std::toupper(static_cast<unsigned char>(file[i])));
  }
  return entity;
}

/// The entity of reference "#5"; empty when there is none.
std::string entity(std::string_view file, const std::string& reference) {
  for (std::size_t at = file.find(reference); at != file.npos; at = file.find(reference, at + 1)) {
    std::size_t i = at + reference.size();
    while (i < file.size() && is_space(file[i])) ++i;
    if (i < file.size() && file[i] == '=') return entity_at(file, i + 1);
  }
  return {};
}

/// All "#123" in s.
std::vector<std::string> references(std::string_view s) {
  std::vector<std::string> found;
  for (std::size_t at = s.find('#'); at != s.npos && found.size() < kMaxUnits; at = s.find('#', at + 1)) {
    std::size_t end = at + 1;
    while (end < s.size() && std::isdigit(static_cast<unsigned char>(s[end]))) ++end;
    found.emplace_back(s.substr(at, end - at));
  }
  return found;
}

double si_prefix(const std::string& si_unit) {
  struct Prefix {
    std::string_view name;
    double factor;
  };
  constexpr Prefix kPrefixes[] = {{".KILO.", 1e3},   {".HECTO.", 1e2},  {".DECA.", 1e1},   {".DECI.", 1e-1},
                                  {".CENTI.", 1e-2}, {".MILLI.", 1e-3}, {".MICRO.", 1e-6}, {".NANO.", 1e-9}};
  for (const Prefix& prefix : kPrefixes) {
    if (si_unit.find(prefix.name) != si_unit.npos) return prefix.factor;
  }
  return 1;
}

}  // namespace

std::optional<double> converted_ifc_unit(std::string_view file) {
  const std::size_t assignment = file.find("IFCUNITASSIGNMENT");
  if (assignment == file.npos) return std::nullopt;
  for (const std::string& reference : references(entity_at(file, assignment))) {
    // IFCCONVERSIONBASEDUNIT(#dimensions, .LENGTHUNIT., 'FOOT', #measure)
    const std::string unit = entity(file, reference);
    if (!unit.starts_with("IFCCONVERSIONBASEDUNIT") || unit.find(".LENGTHUNIT.") == unit.npos) continue;
    const std::vector<std::string> parts = references(unit);
    if (parts.empty()) continue;
    // IFCMEASUREWITHUNIT(IFCLENGTHMEASURE(0.3048), #metre)
    const std::string measure = entity(file, parts.back());
    const std::size_t open = measure.rfind('('), close = measure.find(')', open);
    if (open == measure.npos || close == measure.npos) continue;
    const std::size_t end = measure.find_first_of("),", open + 1);
    const std::optional<double> value = to_number(std::string_view(measure).substr(open + 1, end - open - 1));
    const std::vector<std::string> base = references(measure);
    const double metres = value.value_or(0) * (base.empty() ? 1.0 : si_prefix(entity(file, base.back())));
    if (metres > 1e-9 && metres < 1e9) return metres;
  }
  return std::nullopt;
}

}  // namespace clerestory
