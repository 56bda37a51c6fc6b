#include "io/scene_file/own_materials.h"

#include <algorithm>
#include <cmath>

#include "io/text.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

constexpr std::size_t kShown = 6;

}  // namespace

void NameList::add(const std::string& name, const std::string& remark) {
  if (count_ == 0) first_ = name;
  if (++count_ > kShown) return;
  list_ += (list_.empty() ? "'" : ", '") + quotable(name) + "'" + (remark.empty() ? "" : " " + remark);
}

std::string NameList::str() const { return count_ > kShown ? text(list_, " and ", count_ - kShown, " more") : list_; }

Material OwnMaterials::settle(const ModelMaterial& own) {
  Material material = own.material;
  if (!own.described) undescribed_.add(material.name);
  if (!own.took.empty()) {
    const std::string file = "(" + own.took + ")";
    textured_.add(material.name, (textured_.empty() ? "takes the mean of its texture " : "") + file);
  }
  if (!own.kept.empty()) unread_.add(material.name, "(" + own.kept + ")");
  if (own.unitless_glow) glowing_.add(material.name);
  if (material.kind == MaterialKind::glass) glass_.add(material.name);
  if (material.reflectance.max() >= 1) {
    if (material.kind != MaterialKind::glass) white_.add(material.name);
    for (double& rho : material.reflectance.c) rho = std::min(rho, kWhitestReflectance);
  }
  if (own.gloss && material.receives()) settle_gloss(*own.gloss, material);
  return material;
}

void OwnMaterials::settle_gloss(const ModelGloss& gloss, Material& material) {
  const Spectrum specular = gloss.of_all + gloss.of_colour * material.reflectance;
  const Spectrum diffuse = (1 - gloss.of_colour) * material.reflectance, all = specular + diffuse;
  if (!(specular.max() > 0)) return;
  if (!takes_gloss_) {
    const int share = static_cast<int>(std::lround(100 * luminous_mean(specular) / luminous_mean(all)));
    if (share > 0) matt_.add(material.name, text("(", share, " %)"));
    return;
  }
  const double fits = std::min(1.0, kWhitestReflectance / all.max());
  if (fits < 1) too_glossy_.add(material.name, text("(", all.max(), ")"));
  material.kind = MaterialKind::glossy;
  material.reflectance = diffuse * fits;
  material.gloss = Gloss{specular * fits, gloss.exponent, std::max(gloss.roughness, kLeastRoughness)};
}

std::string OwnMaterials::gloss_left_out() const {
  return text("gloss that the model gives to ", matt_.str(),
              ", of the light that each reflects: it is taken as diffuse; --gloss model follows it");
}

std::vector<std::string> OwnMaterials::warnings() const {
  std::vector<std::string> lines;
  if (!undescribed_.empty()) {
    lines.push_back(text("nothing describes the material ", undescribed_.str(), "; reflectance 0.5 is assumed"));
  }
  if (!white_.empty()) {
    lines.push_back(text("reflectance 1 or more is taken as ", kWhitestReflectance, " for ", white_.str()));
  }
  if (!too_glossy_.empty())
    lines.push_back(text("diffuse and glossy reflectance together are more than ", kWhitestReflectance,
                         " and brought down to it in proportion for ", too_glossy_.str()));
  if (!textured_.empty()) lines.push_back(textured_.str());
  if (!unread_.empty()) {
    lines.push_back(text("textures that cannot be read, so that the plain colour counts, or 0.5 where that is white: ",
                         unread_.str()));
  }
  if (!glass_.empty()) {
    lines.push_back(
        text(glass_.str(), " is transparent in the model and taken as glass that passes what it does not cover"));
  }
  if (!glowing_.empty()) {
    lines.push_back(text(glowing_.str(), " glows without a unit; the model's value is taken as radiance in W/(m2 sr)"));
  }
  return lines;
}

}  // namespace clerestory
