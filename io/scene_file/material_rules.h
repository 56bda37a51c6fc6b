#pragma once
// The "materials" of a scene file: name patterns and what they say, first match wins.

#include <string>
#include <string_view>
#include <vector>

#include "io/scene_file/json_object.h"
#include "solver/model/material.h"

namespace clerestory {

struct MaterialRule {
  std::string pattern;
  Material material;              ///< its name is not used
  std::vector<std::string> used;  ///< names of the model's materials that it decided
};

/// Sees to it that a scene has one channel or three: arrays of one and of three values do not go together.
class ChannelCount {
 public:
  /// throws  InputError naming both places.
  void note(const JsonColour& colour, const std::string& place);

 private:
  int length_ = 0;
  std::string first_place_;
};

/// True when `name` is what `pattern` says, * standing for any text and ? for any letter.
bool matches(std::string_view pattern, std::string_view name);

/// throws  InputError for unknown keys, values out of range, two emissions in one material, kinds not yet available.
std::vector<MaterialRule> read_material_rules(const Json& materials, const std::string& file_name,
                                              ChannelCount& channels, std::vector<std::string>& warnings);

/// The first rule that matches says all about the material but its name. False: none did, and it stays as it is.
bool apply_rules(std::vector<MaterialRule>& rules, Material& material);

}  // namespace clerestory
