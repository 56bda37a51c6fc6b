// IESNA LM-63: label lines, TILT, ten numbers about the luminaire, three about its ballast, angles, candelas.
// Source: IESNA LM-63-1986, -1991, -1995, ANSI/IESNA LM-63-2002, ANSI/IES LM-63-2019.
#include "io/formats/ies.h"

#include <cmath>

#include "io/find_file.h"
#include "io/formats/number_words.h"
#include "io/formats/photometry.h"
#include "io/input_file.h"

namespace clerestory {
namespace {

constexpr std::uintmax_t kMaxBytes = 64u << 20;
constexpr double kMostAngles = 10'000;
constexpr double kMetresPerFoot = 0.3048;
constexpr std::string_view kSeparators = " \t\v\f,;\x1a";  // 0x1a ended files once

class IesReader {
 public:
  IesReader(std::string_view bytes, const std::string& name, const std::filesystem::path& folder,
            std::vector<std::string>& warnings, std::vector<std::filesystem::path>* named)
      : words_(bytes, name, kSeparators), folder_(folder), warnings_(warnings), named_(named) {
    web_.name = name;
  }

  PhotometricWeb read() {
    read_tilt(find_tilt());
    read_luminaire();
    read_angles();
    read_candelas(words_, scale_, {"candela at V = ", ", H = "}, web_, warnings_);
    words_.end(warnings_, [&](std::size_t more) {
      words_.refuse(text(more, more == 1 ? " more number than " : " more numbers than ", vertical_count_, " x ",
                         horizontal_count_, " candelas; the counts of angles do not fit the data"));
    });
    if (web_.type == WebType::C) fit_circle();
    const double lamps = web_.lamp_flux * std::max(1.0, scale_);
    complete_web(web_, lamps, true, warnings_);
    return std::move(web_);
  }

 private:
  /// What stands behind TILT=. Everything before it are labels, and a line that tells the edition.
  std::string find_tilt() {
    std::string_view line;
    while (words_.line(line)) {
      line = trimmed(line);
      if (words_.line_number() == 1) since_2002_ = line.find("LM-63-20") != line.npos;  // 2002, 2019 and what may come
      if (to_lower(line.substr(0, 4)) != "tilt") continue;
      const std::string_view rest = trimmed(line.substr(4));
      if (rest.starts_with("=")) return std::string(trimmed(rest.substr(1)));
    }
    words_.refuse(
        "no line TILT=NONE, TILT=INCLUDE or TILT=file; this is not an IESNA LM-63 file, or a part is missing");
  }

  void read_tilt(const std::string& tilt) {
    const std::string kind = to_lower(tilt);
    if (kind == "none") return;
    if (kind == "include") return read_tilt_table(words_);
    if (tilt.empty()) words_.refuse("TILT= says nothing; NONE, INCLUDE or the name of a file is known");
    const auto file = FileFinder().file(folder_, tilt);
    if (named_) named_->push_back(file.value_or(folder_ / tilt));
    if (!file) {
      words_.refuse(text("TILT names the file '", quotable(tilt),
                         "', which is not there; put it beside this file, or write TILT=NONE"));
    }
    const std::string bytes = read_input_file(*file, kMaxBytes);
    NumberWords words(bytes, short_name(*file), kSeparators);
    read_tilt_table(words);
  }

  void read_tilt_table(NumberWords& words) {
    const double geometry = words.number([] { return "the lamp-to-luminaire geometry of TILT"; });
    if (geometry != 1 && geometry != 2 && geometry != 3)
      words.refuse(text("lamp-to-luminaire geometry of TILT = ", geometry, "; 1, 2 and 3 are known"));
    const auto n = count(words, 1, "number of tilt angles");
    std::vector<double> angle(n), factor(n);
    for (double& a : angle) a = words.number([] { return "a tilt angle"; });
    for (std::size_t i = 1; i < n; ++i)
      if (!(angle[i] > angle[i - 1]))
        words.refuse(text("tilt angles are not ascending: ", angle[i], " follows ", angle[i - 1]));
    for (double& f : factor) {
      f = words.number([] { return "a tilt factor"; });
      if (f < 0) words.refuse(text("tilt factor = ", f, " is negative"));
    }
    if (geometry == 2) return;  // the lamp stays horizontal however the luminaire is tilted
    web_.tilt_deg = std::move(angle), web_.tilt_factor = std::move(factor);
  }

  void read_luminaire() {
    const double lamps = words_.number([] { return "the number of lamps"; });
    const double lumens = words_.number([] { return "the lumens per lamp"; });
    const double multiplier = positive("the multiplier of the candelas");
    vertical_count_ = count(words_, 2, "number of vertical angles");
    horizontal_count_ = count(words_, 1, "number of horizontal angles");
    const double type = words_.number([] { return "the photometric type"; });
    if (type != 1 && type != 2 && type != 3)
      words_.refuse(text("photometric type = ", type, "; 1 (C), 2 (B) and 3 (A) are known"));
    web_.type = type == 1 ? WebType::C : type == 2 ? WebType::B : WebType::A;
    if (web_.type != WebType::C && horizontal_count_ < 2)
      words_.refuse("one horizontal angle; types A and B need two or more");
    const double units = words_.number([] { return "the type of units"; });
    if (units != 1 && units != 2) words_.refuse(text("type of units = ", units, "; 1 (feet) and 2 (metres) are known"));
    const double metres = units == 1 ? kMetresPerFoot : 1;
    const double width = words_.number([] { return "the width of the opening"; });
    const double length = words_.number([] { return "the length of the opening"; });
    const double height = words_.number([] { return "the height of the opening"; });
    set_opening(width * metres, length * metres, height * metres);
    const double ballast = positive("the ballast factor");
    double lamp_factor = words_.number([] { return "the ballast-lamp photometric factor (or future use)"; });
    words_.number([] { return "the input watts"; });
    // A factor until 1995, then for future use, and since 2019 a code that tells how the file was made.
    if (since_2002_) lamp_factor = 1;
    if (!(lamp_factor > 0)) {
      warnings_.push_back(text(web_.name, ": its ballast-lamp photometric factor is ", lamp_factor, "; 1 is taken"));
      lamp_factor = 1;
    }
    if (lumens > 0 && lamps > 0) web_.lamp_flux = lamps * lumens;
    scale_ = multiplier * ballast * lamp_factor;
  }

  /// Negative lengths say round. Length lies along the photometric horizontal, width across it. A round opening may
  /// have its diameter as width alone.
  void set_opening(double width, double length, double height) {
    web_.opening.round = width < 0 || length < 0;
    if (web_.opening.round && length == 0 && height >= 0) length = width;
    if (web_.opening.round && width == 0 && height >= 0) width = length;
    web_.opening.size = {std::abs(length), std::abs(width), std::abs(height)};
  }

  void read_angles() {
    const double lowest = web_.type == WebType::C ? 0 : -90, highest = web_.type == WebType::C ? 180 : 90;
    read_ascending(web_.vertical, vertical_count_, "vertical", lowest, highest);
    read_ascending(web_.horizontal, horizontal_count_, "horizontal", web_.type == WebType::C ? 0 : -180,
                   web_.type == WebType::C ? 360 : 180);
    const double first = web_.horizontal.front(), last = web_.horizontal.back();
    if (web_.type != WebType::C) {
      if (first == 0) web_.symmetry = WebSymmetry::about_0_180;
      return;
    }
    const auto symmetry = symmetry_of(web_.horizontal);
    if (!symmetry)
      words_.refuse(text("horizontal angles go from ", first, " to ", last,
                         "; type C takes 0 alone, 0 to 90, 0 to 180, 90 to 270 or 0 to 360"));
    web_.symmetry = *symmetry;
  }

  void read_ascending(std::vector<double>& angles, std::size_t n, const char* name, double low, double high) {
    const auto what = [&] { return text(name, " angle ", angles.size() + 1, " of ", n); };
    while (angles.size() < n) {
      const double a = words_.number(what);
      if (a < low || a > high) words_.refuse(text(what(), " = ", a, " is outside [", low, ", ", high, "] degrees"));
      if (!angles.empty() && !(a > angles.back()))
        words_.refuse(text(name, " angles are not ascending: ", a, " follows ", angles.back()));
      angles.push_back(a);
    }
  }

  /// Planes that stop short of 360 degrees, 0 to 345: the first one closes the circle.
  void fit_circle() {
    const double last = web_.horizontal.back();
    if (web_.symmetry != WebSymmetry::none || last == 360) return;
    warnings_.push_back(
        text(web_.name, ": its horizontal angles end at ", last, " degrees; the plane of 0 is taken for 360"));
  }

  double positive(const char* what) {
    const double x = words_.number([&] { return what; });
    if (!(x > 0)) words_.refuse(text(what, " = ", x, "; it must be positive"));
    return x;
  }

  static std::size_t count(NumberWords& words, double least, const char* what) {
    const double n = words.number([&] { return text("the ", what); });
    if (!(n >= least && n <= kMostAngles && n == std::floor(n)))
      words.refuse(text(what, " = ", n, "; a whole number in [", least, ", ", kMostAngles, "] is expected"));
    return static_cast<std::size_t>(n);
  }

  NumberWords words_;
  const std::filesystem::path& folder_;
  std::vector<std::string>& warnings_;
  std::vector<std::filesystem::path>* named_;
  PhotometricWeb web_;
  bool since_2002_ = false;
  std::size_t vertical_count_ = 0, horizontal_count_ = 0;
  double scale_ = 1;  ///< multiplier and factors of the ballast
};

}  // namespace

PhotometricWeb parse_ies(std::string_view bytes, const std::string& name, const std::filesystem::path& folder,
                         std::vector<std::string>& warnings, std::vector<std::filesystem::path>* named) {
  return IesReader(bytes, name, folder, warnings, named).read();
}

PhotometricWeb read_ies(const std::filesystem::path& file, std::vector<std::string>& warnings,
                        std::vector<std::filesystem::path>* named) {
  return parse_ies(read_input_file(file, kMaxBytes), short_name(file), file.parent_path(), warnings, named);
}

}  // namespace clerestory
