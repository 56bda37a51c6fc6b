#pragma once
// JSON text -> JSON value, within bounds.

#include <string>
#include <string_view>

namespace clerestory {

struct JsonLimits {
  int deepest = 32;              ///< levels of nesting; a scene file needs 4
  std::size_t most_keys = 2000;  ///< of one object; an ordered object takes quadratic time for many
};

/// Parses text with `//` and `/* */` comments. AnyJson is nlohmann::json or nlohmann::ordered_json.
///
/// throws  InputError: "room.json:3:5: is not valid JSON: ...", too deep, a key given twice, a number beyond double.
template <class AnyJson>
AnyJson parse_json(std::string_view bytes, const std::string& file_name, const JsonLimits& limits = {});

}  // namespace clerestory
