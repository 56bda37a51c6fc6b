#include <algorithm>
#include <charconv>
#include <numeric>

#include "io/bake/baked_files.h"
#include "io/text.h"
#include "solver/model/exposure.h"

namespace clerestory {
namespace {

constexpr std::size_t kEnough = 1 << 20;

class Lines {
 public:
  explicit Lines(AtomicFile& file) : file_(file) {}

  Lines& operator<<(std::string_view words) {
    text_ += words;
    return *this;
  }
  /// As few digits as read back the same.
  template <class Number>
  Lines& number(Number value) {
    char digits[32];
    text_ += ' ';
    text_.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
    return *this;
  }
  void end() {
    text_ += '\n';
    if (text_.size() >= kEnough) flush();
  }
  void flush() {
    file_.write(text_);
    text_.clear();
  }

 private:
  AtomicFile& file_;
  std::string text_;
};

}  // namespace

void write_baked_obj(AtomicFile& file, const BakedMesh& mesh, const BakedNames& names, double exposure) {
  Lines lines(file);
  lines << "# Clerestory: light as vertex colours, sRGB; metres";
  lines.end();
  lines << "# exposure";
  lines.number(exposure).end();
  for (std::size_t i = 0; i < mesh.position.size(); ++i) {
    const Vec3& p = mesh.position[i];
    const Spectrum shown = mesh.shown[i] * exposure;
    lines << "v";
    lines.number(p.x).number(p.y).number(p.z);
    for (int k = 0; k < 3; ++k) lines.number(static_cast<float>(srgb_encoded(shown[k])));
    lines.end();
  }
  for (const Vec3& n : mesh.normal) {
    lines << "vn";
    lines.number(static_cast<float>(n.x)).number(static_cast<float>(n.y)).number(static_cast<float>(n.z)).end();
  }
  std::vector<std::uint32_t> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, {}, [&](std::uint32_t t) { return mesh.surface[t]; });
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::uint32_t t = order[k];
    if (k == 0 || mesh.surface[t] != mesh.surface[order[k - 1]]) {
      const std::string name = clean_text(names.surfaces[mesh.surface[t]]);
      lines << "o " << (name.empty() ? text("surface ", mesh.surface[t] + 1) : name);
      lines.end();
    }
    lines << "f";
    for (const std::uint32_t corner : mesh.triangles[t]) {
      lines.number(corner + 1) << "//";
      char digits[16];
      lines << std::string_view(digits, std::to_chars(digits, digits + sizeof digits, corner + 1).ptr);
    }
    lines.end();
  }
  lines.flush();
}

}  // namespace clerestory
