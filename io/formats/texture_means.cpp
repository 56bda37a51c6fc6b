#include "io/formats/texture_means.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>

#include "io/formats/decode_image.h"
#include "io/formats/image_module.h"
#include "io/formats/run_apart.h"
#include "io/text.h"

namespace clerestory {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kPatience{60};  ///< for all textures of a model
constexpr std::uint64_t kMemory = std::uint64_t{4} << 30;

/// The mean of a texture, or why there is none.
struct Answer {
  Spectrum mean;
  std::string problem;
};

std::string_view format_of(std::string_view head, const std::string& extension) {
  struct Known {
    std::string_view magic, format;
  };
  constexpr Known kKnown[] = {{"\x89PNG", "png"},     {"\xff\xd8\xff", "jpeg"}, {"GIF8", "gif"}, {"BM", "bmp"},
                              {"II*", "tiff"},        {"MM", "tiff"},           {"DDS ", "dds"}, {"#?", "hdr"},
                              {"v/1\x01", "openexr"}, {"8BPS", "psd"}};
  for (const Known& known : kKnown)
    if (head.starts_with(known.magic)) return known.format;
  if (head.starts_with("RIFF") && head.substr(std::min<std::size_t>(8, head.size())).starts_with("WEBP")) return "webp";
  return extension == ".tga" ? "targa" : "";
}

/// In the child: three doubles behind 'm', or 'e' and what is wrong.
std::string mean_of(const ModelTexture& texture) {
  if (texture.file.empty() && texture.bytes.empty()) return "eis not there";
  std::string head = texture.bytes.substr(0, 16);
  if (head.empty()) {
    std::ifstream in(texture.file, std::ios::binary);
    head.resize(16);
    in.read(head.data(), 16);
    head.resize(static_cast<std::size_t>(in.gcount()));
  }
  const std::string format(format_of(head, to_lower(texture.file.extension().string())));
  if (format.empty()) return "eis no image that is read";
  void* function = image_function(kImageMeanSymbol);
  if (!function) return 'e' + no_image_module();
  std::string answer;
  reinterpret_cast<ImageMean*>(function)(texture.file.c_str(), texture.bytes.data(), texture.bytes.size(),
                                         format.c_str(), &answer, append_bytes);
  return answer;
}

/// In the child: the answers for textures [begin, end), each behind its length.
std::string means_of(const std::vector<const ModelTexture*>& textures, std::size_t begin, std::size_t end) {
  const Clock::time_point deadline = Clock::now() + kPatience;
  std::string answers;
  for (std::size_t i = begin; i < end; ++i) {
    const std::string answer = Clock::now() < deadline ? mean_of(*textures[i]) : "ewould take too long";
    const std::size_t n = answer.size();
    answers.append(reinterpret_cast<const char*>(&n), sizeof n) += answer;
  }
  return answers;
}

Answer parsed(std::string_view answer) {
  double mean[3];
  if (answer.size() != 1 + sizeof mean || answer[0] != 'm')
    return {{}, answer.empty() ? "cannot be read" : std::string(answer.substr(1))};
  std::memcpy(mean, answer.data() + 1, sizeof mean);
  for (const double x : mean)
    if (!(x >= 0 && x <= 1e6)) return {{}, "holds numbers that are no colour"};
  return {{mean[0], mean[1], mean[2]}, ""};
}

std::vector<Answer> parsed_all(std::string_view answers, std::size_t count) {
  std::vector<Answer> all;
  while (all.size() < count) {
    std::size_t n = 0;
    if (answers.size() < sizeof n) throw ApartFailure("breaks off");
    std::memcpy(&n, answers.data(), sizeof n);
    if (n > answers.size() - sizeof n) throw ApartFailure("breaks off");
    all.push_back(parsed(answers.substr(sizeof n, n)));
    answers.remove_prefix(sizeof n + n);
  }
  return all;
}

std::vector<Answer> answers_for(const std::vector<const ModelTexture*>& textures) {
  const std::size_t count = textures.size();
  try {
    return parsed_all(run_apart([&] { return means_of(textures, 0, count); },
                                {.time = kPatience + std::chrono::seconds(30), .memory_bytes = kMemory}),
                      count);
  } catch (const ApartFailure&) {
  }
  const Clock::time_point deadline = Clock::now() + kPatience;
  std::vector<Answer> all;
  for (std::size_t i = 0; i < count; ++i) {
    try {
      if (Clock::now() > deadline) throw ApartFailure("would take too long");
      all.push_back(parsed_all(run_apart([&] { return means_of(textures, i, i + 1); },
                                         {.time = std::chrono::seconds(20), .memory_bytes = kMemory}),
                               1)[0]);
    } catch (const ApartFailure& failure) {
      all.push_back({{}, text("is damaged: reading it ", failure.what())});
    }
  }
  return all;
}

/// White is what exporters write where the texture says all.
bool says_nothing(const Spectrum& colour) { return colour.min() >= 0.95; }

}  // namespace

void take_texture_means(Model& model, const std::function<bool(const std::string& name)>& is_decided) {
  std::vector<bool> carried(model.materials.size(), false), needed(model.textures.size(), false);
  for (const MaterialId m : model.polygons.material) carried[m] = true;
  std::vector<ModelMaterial*> materials;
  for (std::size_t m = 0; m < model.materials.size(); ++m) {
    ModelMaterial& material = model.materials[m];
    if (!carried[m] || !(material.texture || material.glow_texture) || is_decided(material.material.name)) continue;
    materials.push_back(&material);
    for (const auto& texture : {material.texture, material.glow_texture})
      if (texture) needed[*texture] = true;
  }
  std::vector<const ModelTexture*> textures;
  std::vector<std::size_t> place(needed.size());
  for (std::size_t t = 0; t < needed.size(); ++t) {
    place[t] = textures.size();
    if (needed[t]) textures.push_back(&model.textures[t]);
  }
  if (textures.empty()) return;
  const std::vector<Answer> answers = answers_for(textures);

  for (ModelMaterial* material : materials) {
    const auto take = [&](std::size_t texture, Spectrum& colour) {
      const Answer& answer = answers[place[texture]];
      const std::string name = quotable(model.textures[texture].name);
      std::string& note = answer.problem.empty() ? material->took : material->kept;
      note += (note.empty() ? "" : ", ") + (answer.problem.empty() ? name : text(name, " ", answer.problem));
      if (answer.problem.empty()) colour *= answer.mean;
      return answer.problem.empty();
    };
    Material& m = material->material;
    if (material->texture && m.receives()) {
      if (!take(*material->texture, m.reflectance) && says_nothing(m.reflectance)) m.reflectance = Spectrum(0.5);
    }
    if (material->glow_texture && !m.exitance.is_black()) take(*material->glow_texture, m.exitance);
  }
}

}  // namespace clerestory
