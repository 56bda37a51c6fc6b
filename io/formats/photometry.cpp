#include "io/formats/photometry.h"

#include <algorithm>
#include <cmath>

#include "io/formats/ies.h"
#include "io/formats/ldt.h"
#include "io/formats/number_words.h"
#include "io/input_file.h"
#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

constexpr double kOdd = 0.05;  // fluxes that differ by more are worth a word

/// Angles all round, each with the plane that holds its intensities.
struct Planes {
  std::vector<std::pair<double, std::size_t>> at;

  void add(double angle, std::size_t plane) {
    if (angle > -1e-9 && angle < 360 + 1e-9) at.emplace_back(angle, plane);
  }
};

void make_full_circle(PhotometricWeb& web) {
  Planes planes;
  for (std::size_t k = 0; k < web.horizontal.size(); ++k) {
    const double h = web.horizontal[k];
    const bool sides = web.symmetry == WebSymmetry::about_0_180 || web.symmetry == WebSymmetry::quadrants;
    const bool ends = web.symmetry == WebSymmetry::about_90_270 || web.symmetry == WebSymmetry::quadrants;
    for (const double turn : {-360.0, 0.0, 360.0}) {
      planes.add(h + turn, k);
      if (sides) planes.add(-h + turn, k);
      if (ends) planes.add(180 - h + turn, k);
      if (sides && ends) planes.add(180 + h + turn, k);
    }
  }
  std::stable_sort(planes.at.begin(), planes.at.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  const auto end = std::unique(planes.at.begin(), planes.at.end(),
                               [](const auto& a, const auto& b) { return b.first - a.first < 1e-9; });
  planes.at.erase(end, planes.at.end());

  const std::size_t n = web.vertical.size();
  std::vector<double> horizontal;
  std::vector<float> candela;
  for (const auto& [angle, plane] : planes.at) {
    horizontal.push_back(angle);
    const auto from = web.candela.begin() + static_cast<std::ptrdiff_t>(plane * n);
    candela.insert(candela.end(), from, from + static_cast<std::ptrdiff_t>(n));
  }
  web.horizontal = std::move(horizontal);
  web.candela = std::move(candela);
}

void mirror_right_to_left(PhotometricWeb& web) {
  const std::size_t n = web.vertical.size(), m = web.horizontal.size();
  std::vector<double> horizontal;
  std::vector<float> candela;
  for (std::size_t k = 0; k < 2 * m - 1; ++k) {
    const std::size_t plane = k < m ? m - 1 - k : k - m + 1;
    horizontal.push_back(k < m ? -web.horizontal[plane] : web.horizontal[plane]);
    const auto from = web.candela.begin() + static_cast<std::ptrdiff_t>(plane * n);
    candela.insert(candela.end(), from, from + static_cast<std::ptrdiff_t>(n));
  }
  web.horizontal = std::move(horizontal);
  web.candela = std::move(candela);
}

/// returns  the place of the first negative candela that is no meter's offset; candela.size() where there is none.
std::size_t settle_negative(PhotometricWeb& web, std::vector<std::string>& warnings) {
  std::vector<float>& I = web.candela;
  const float least = -0.05f * *std::max_element(I.begin(), I.end());
  const auto wrong = std::find_if(I.begin(), I.end(), [&](float x) { return x < 0 && x < least; });
  if (wrong != I.end()) return static_cast<std::size_t>(wrong - I.begin());
  const auto negative = std::count_if(I.begin(), I.end(), [](float x) { return x < 0; });
  if (negative == 0) return I.size();
  warnings.push_back(text(web.name, ": ", negative, negative == 1 ? " intensity is" : " intensities are",
                          " negative, down to ", std::round(*std::min_element(I.begin(), I.end()) * 1e6) / 1e6,
                          " cd; 0 is taken"));
  for (float& x : I) x = std::max(x, 0.0f);
  return I.size();
}

}  // namespace

void read_candelas(NumberWords& words, double scale, const std::pair<std::string_view, std::string_view>& at,
                   PhotometricWeb& web, std::vector<std::string>& warnings) {
  const std::size_t n = web.vertical.size();
  std::vector<std::size_t> line;
  const auto what = [&](std::size_t i) {
    return text(at.first, web.vertical[i % n], at.second, web.horizontal[i / n]);
  };
  for (std::size_t i = 0; i < n * web.horizontal.size(); ++i) {
    web.candela.push_back(static_cast<float>(words.number([&] { return what(i); }) * scale));
    line.push_back(words.line_number());
  }
  if (const std::size_t i = settle_negative(web, warnings); i < web.candela.size())
    throw InputError(text(web.name, ":", line[i], ": ", what(i), " = ", std::round(web.candela[i] / scale * 1e6) / 1e6,
                          " is negative, more than a meter's offset is; correct it, or take another file"));
}

void complete_web(PhotometricWeb& web, double declared, bool at_most, std::vector<std::string>& warnings) {
  if (web.type != WebType::C) {
    if (web.symmetry != WebSymmetry::none) mirror_right_to_left(web);
  } else if (web.symmetry != WebSymmetry::rotational) {
    make_full_circle(web);
  }
  if (web.type == WebType::C) {
    const double first = web.vertical.front(), last = web.vertical.back();
    if ((first != 0 && first != 90) || (last != 90 && last != 180)) {
      warnings.push_back(text(web.name, ": its vertical angles go from ", first, " to ", last,
                              " degrees; no light is taken beyond them"));
    }
  }
  const double flux = web.flux = luminous_flux(web);
  if (!(flux > 0)) {
    warnings.push_back(web.name + ": all its intensities are 0; it gives no light");
  } else if (declared > 0 && (flux > declared * (1 + kOdd) || (!at_most && flux < declared * (1 - kOdd)))) {
    warnings.push_back(text(web.name, ": its intensities add up to ", std::round(flux * 10) / 10, " lm, ",
                            at_most ? "more than its lamps give, " : "and not to what it declares, ",
                            std::round(declared * 10) / 10, " lm; the intensities count"));
  }
}

std::optional<WebSymmetry> symmetry_of(const std::vector<double>& horizontal) {
  if (horizontal.size() == 1) return WebSymmetry::rotational;
  const double first = horizontal.front(), last = horizontal.back();
  if (first == 90 && last == 270) return WebSymmetry::about_90_270;
  if (first != 0) return std::nullopt;
  if (last == 90) return WebSymmetry::quadrants;
  if (last == 180) return WebSymmetry::about_0_180;
  return last > 180 ? std::optional(WebSymmetry::none) : std::nullopt;
}

std::shared_ptr<const PhotometricWeb> PhotometryFiles::read(const std::filesystem::path& file,
                                                            std::vector<std::string>& warnings,
                                                            std::vector<std::filesystem::path>& named) {
  auto& web = read_before_[file.lexically_normal()];
  if (web) return web;
  named.push_back(file);
  return web = std::make_shared<const PhotometricWeb>(read_photometry(file, warnings, &named));
}

PhotometricWeb read_photometry(const std::filesystem::path& file, std::vector<std::string>& warnings,
                               std::vector<std::filesystem::path>* named) {
  const std::string extension = to_lower(file.extension().string());
  if (extension == ".ies") return read_ies(file, warnings, named);
  if (extension == ".ldt") return read_ldt(file, warnings);
  throw InputError(text(short_name(file), ": the extension '", quotable(extension),
                        "' is no photometric file's; .ies (IESNA LM-63) and .ldt (EULUMDAT) are read"));
}

}  // namespace clerestory
