#include "pipeline/bake/bake_model.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include "io/input_file.h"
#include "pipeline/bake/light_on_model.h"
#include "pipeline/bake/polygon_parts.h"
#include "solver/model/bake_points.h"

namespace clerestory {
namespace {

void add_field(Field& to, const Field& from) { to.value.insert(to.value.end(), from.value.begin(), from.value.end()); }

void add_part(BakedMesh& to, const ModelPart& part, const LitPart& lit, std::size_t surface, std::size_t material) {
  const auto first = static_cast<std::uint32_t>(to.position.size());
  for (const std::uint32_t v : lit.vertex) to.position.push_back(part.position[v]);
  to.normal.insert(to.normal.end(), lit.normal.begin(), lit.normal.end());
  to.E.channels = lit.E.channels, to.shown.channels = lit.shown.channels;
  add_field(to.E, lit.E), add_field(to.shown, lit.shown);
  to.illuminance.insert(to.illuminance.end(), lit.illuminance.begin(), lit.illuminance.end());
  for (const auto& [a, b, c] : lit.triangles) {
    to.triangles.push_back({a + first, b + first, c + first});
    to.surface.push_back(static_cast<std::uint32_t>(surface));
    to.material.push_back(static_cast<std::uint32_t>(material));
  }
}

/// Materials of the result by their name, and those of the scene that no light reaches behind them.
class MaterialNumbers {
 public:
  MaterialNumbers(const Scene& scene, BakedNames& names) : scene_(scene), names_(names) {
    for (std::size_t m = 0; m < names.materials.size(); ++m) number_.try_emplace(names.materials[m].name, m);
  }
  std::size_t operator()(MaterialId material, const LitPart& lit) {
    if (lit.material) return *lit.material;
    const auto [at, is_new] = number_.try_emplace(scene_.materials[material].name, names_.materials.size());
    if (is_new) {
      names_.materials.push_back(scene_.materials[material]);
      names_.glows.push_back(false);
    }
    return at->second;
  }

 private:
  const Scene& scene_;
  BakedNames& names_;
  std::map<std::string, std::size_t> number_;
};

}  // namespace

BakedScene bake_scene(const WrittenResult& result, const Scene& scene) {
  BakedScene baked;
  baked.names = {scene.surfaces, result.materials, glowing_materials(result)};
  std::vector<ModelPart> parts;
  std::vector<std::size_t> end;  // of each model's parts, of glTF
  std::vector<bool> as_polygons(scene.surfaces.size(), true);
  std::vector<std::size_t> model_of(scene.surfaces.size(), 0);
  for (const PlacedModel& model : scene.models) {
    LitModelFile& lit = baked.models.emplace_back();
    lit.name = short_name(model.file);
    lit.gltf = read_gltf_again(model);
    for (std::size_t s = model.first_surface; s < model.first_surface + model.surface_count; ++s) {
      as_polygons[s] = !lit.gltf;
      model_of[s] = baked.models.size() - 1;
    }
    if (lit.gltf) parts.insert(parts.end(), parts_of(*lit.gltf).begin(), parts_of(*lit.gltf).end());
    end.push_back(parts.size());
  }
  PolygonParts polygons = polygon_parts(scene, as_polygons);
  const std::size_t of_gltf = parts.size();
  std::ranges::move(polygons.parts, std::back_inserter(parts));

  LitModel lit = light_on_model(result, parts);
  baked.parts = std::move(lit.parts);
  baked.missing_share = lit.missing_share;
  for (std::size_t m = 0; m < baked.models.size(); ++m) {
    const std::size_t begin = m == 0 ? 0 : end[m - 1];
    baked.models[m].parts = std::span<const LitPart>(baked.parts).subspan(begin, end[m] - begin);
  }
  MaterialNumbers number(scene, baked.names);
  for (std::size_t p = of_gltf; p < parts.size(); ++p) {
    const SurfaceId surface = polygons.surface[p - of_gltf];
    add_part(baked.models[model_of[surface]].mesh, parts[p], baked.parts[p], surface,
             number(polygons.material[p - of_gltf], baked.parts[p]));
  }
  return baked;
}

NamedMesh as_one_mesh(const BakedScene& scene) {
  NamedMesh all;
  all.names = scene.names;
  for (const LitModelFile& model : scene.models) {
    if (!model.gltf) {
      const BakedMesh& from = model.mesh;
      const auto first = static_cast<std::uint32_t>(all.mesh.position.size());
      BakedMesh& to = all.mesh;
      to.position.insert(to.position.end(), from.position.begin(), from.position.end());
      to.normal.insert(to.normal.end(), from.normal.begin(), from.normal.end());
      if (!from.position.empty()) to.E.channels = from.E.channels, to.shown.channels = from.shown.channels;
      add_field(to.E, from.E), add_field(to.shown, from.shown);
      to.illuminance.insert(to.illuminance.end(), from.illuminance.begin(), from.illuminance.end());
      for (const auto& [a, b, c] : from.triangles) to.triangles.push_back({a + first, b + first, c + first});
      to.surface.insert(to.surface.end(), from.surface.begin(), from.surface.end());
      to.material.insert(to.material.end(), from.material.begin(), from.material.end());
      continue;
    }
    const std::vector<ModelPart>& parts = parts_of(*model.gltf);
    for (std::size_t p = 0; p < parts.size(); ++p) {
      if (all.names.surfaces.empty() || p == 0 || all.names.surfaces.back() != parts[p].name)
        all.names.surfaces.push_back(parts[p].name);
      add_part(all.mesh, parts[p], model.parts[p], all.names.surfaces.size() - 1, model.parts[p].material.value_or(0));
    }
  }
  return all;
}

}  // namespace clerestory
