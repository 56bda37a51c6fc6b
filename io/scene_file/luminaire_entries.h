#pragma once
// The "luminaires" of a scene file.

#include <filesystem>
#include <optional>
#include <string>

#include "io/formats/model.h"
#include "io/formats/photometry.h"
#include "io/scene_file/json_object.h"
#include "io/scene_file/material_rules.h"
#include "solver/model/scene.h"

namespace clerestory {

/// Reads all of them from the scene's root object into the scene, whose files get those of `photometry` that are read.
///
/// folder  of the scene file; the names of photometric files are relative to it.
/// throws  InputError.
void read_luminaire_entries(const JsonObject& root, const std::string& file_name, const std::filesystem::path& folder,
                            PhotometryFiles& photometry, ChannelCount& channels, Scene& scene);

/// What luminaire a lamp is that a model places: of "fixtures", patterns of its name and its type's, first match wins.
struct FixtureRule {
  std::string pattern, group;
  WebLuminaire luminaire;  ///< axes as it shines along the fixture's own -z
  bool flux_is_given = false;
  std::size_t used = 0;
};

/// The rules of the scene's root object, read as read_luminaire_entries reads.
///
/// throws  InputError.
std::vector<FixtureRule> read_fixture_rules(const JsonObject& root, const std::string& file_name,
                                            const std::filesystem::path& folder, PhotometryFiles& photometry,
                                            ChannelCount& channels, Scene& scene);

/// The luminaire of the first rule that matches one of the fixture's names; nothing when none does.
std::optional<Luminaire> apply_rules(std::vector<FixtureRule>& rules, const ModelFixture& fixture);

}  // namespace clerestory
