#pragma once
// Models made of quadrilaterals, as OBJ.

#include <array>
#include <cstdio>
#include <string>
#include <utility>

#include "solver/model/vec.h"

namespace clerestory::test {

using Quad = std::array<Vec3, 4>;

/// A model in text, as exact as double is.
class ModelText {
 public:
  ModelText& object(const std::string& name, const std::string& material) {
    text_ += "o " + name + "\nusemtl " + material + "\n";
    return *this;
  }
  ModelText& quad(const Quad& corners) {
    char line[120];
    for (const Vec3& p : corners) {
      std::snprintf(line, sizeof line, "v %.17g %.17g %.17g\n", p.x, p.y, p.z);
      text_ += line;
    }
    text_ += "f -4 -3 -2 -1\n";
    return *this;
  }
  /// Six sides that look outwards, or inwards.
  ModelText& box(const Vec3& a, const Vec3& b, bool outwards) {
    const auto side = [&](Quad q) {
      if (!outwards) std::swap(q[1], q[3]);
      quad(q);
    };
    side({Vec3{a.x, a.y, a.z}, {a.x, b.y, a.z}, {b.x, b.y, a.z}, {b.x, a.y, a.z}});
    side({Vec3{a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z}});
    side({Vec3{a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, a.y, b.z}, {a.x, a.y, b.z}});
    side({Vec3{a.x, b.y, a.z}, {a.x, b.y, b.z}, {b.x, b.y, b.z}, {b.x, b.y, a.z}});
    side({Vec3{a.x, a.y, a.z}, {a.x, a.y, b.z}, {a.x, b.y, b.z}, {a.x, b.y, a.z}});
    side({Vec3{b.x, a.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z}, {b.x, a.y, b.z}});
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

}  // namespace clerestory::test
