#include <algorithm>

#include "io/formats/model.h"
#include "io/text.h"

namespace clerestory {
namespace {

/// 'a', 'b', 'c' and 12 more
class NameList {
 public:
  void add(const std::string& name) {
    if (++count_ <= kShown) list_ += (list_.empty() ? "'" : ", '") + quotable(name) + "'";
  }
  bool empty() const { return count_ == 0; }
  std::string str() const { return count_ > kShown ? text(list_, " and ", count_ - kShown, " more") : list_; }

 private:
  static constexpr std::size_t kShown = 6;
  std::string list_;
  std::size_t count_ = 0;
};

}  // namespace

void apply_opacity(Material& material, double opacity) {
  if (!(opacity < 0.5)) return;
  material.kind = MaterialKind::glass;
  material.transmittance = Spectrum(1 - std::max(opacity, 0.0));
  material.exitance = Spectrum(0.0);
}

void settle_materials(Model& model) {
  NameList white, glass;
  for (Material& material : model.materials) {
    if (material.kind == MaterialKind::glass) glass.add(material.name);
    if (material.reflectance.max() < 1) continue;
    for (double& rho : material.reflectance.c) rho = std::min(rho, kWhitestReflectance);
    white.add(material.name);
  }
  if (!white.empty()) {
    model.warnings.push_back(text("reflectance 1 or more is taken as ", kWhitestReflectance, " for ", white.str(),
                                  "; give measured reflectances under \"materials\" of a scene file"));
  }
  if (!glass.empty()) {
    model.warnings.push_back(text(glass.str(),
                                  " is transparent in the model and taken as glass that passes the part it ",
                                  "does not cover; give its transmittance under \"materials\" of a scene file"));
  }
}

}  // namespace clerestory
