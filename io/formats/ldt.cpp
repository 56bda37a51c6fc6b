// EULUMDAT: one value a line, 26 about the luminaire, six for each set of lamps, ten direct ratios, angles, candelas
// per 1,000 lm. Source: Stockmar, "EULUMDAT - ein Leuchtendatenformat fuer den europaeischen Beleuchtungsplaner", 1990.
#include "io/formats/ldt.h"

#include <cmath>

#include "io/formats/number_words.h"
#include "io/formats/photometry.h"
#include "io/input_file.h"

namespace clerestory {
namespace {

constexpr std::uintmax_t kMaxBytes = 64u << 20;
constexpr double kMostAngles = 10'000;
constexpr int kMostLampSets = 20;

class LdtReader {
 public:
  LdtReader(std::string_view bytes, const std::string& name, std::vector<std::string>& warnings)
      : words_(bytes, name, " \t\v\f;\x1a"), warnings_(warnings) {
    web_.name = name;
  }

  PhotometricWeb read() {
    skip("the company");
    value("the type indicator");
    symmetry_ = whole("the symmetry indicator", 0, 4);
    planes_ = whole("the number of C planes", 1, kMostAngles);
    value("the distance between C planes");
    gammas_ = whole("the number of intensities in a plane", 2, kMostAngles);
    value("the distance between intensities");
    for (const char* text : {"the test report", "the luminaire's name", "its number", "the file name", "the date"})
      skip(text);
    for (const char* size : {"the luminaire's length", "its width", "its height"}) value(size);
    read_opening();
    value("the downward flux fraction");
    const double output_ratio = value("the light output ratio");
    double conversion = value("the conversion factor");
    if (!(conversion > 0)) {
      warnings_.push_back(text(web_.name, ": its conversion factor is ", conversion, "; 1 is taken"));
      conversion = 1;
    }
    if (const double tilt = value("the tilt while measuring"); tilt != 0)
      warnings_.push_back(text(web_.name, ": measured at a tilt of ", tilt, " degrees, which is not undone"));
    read_lamps();
    for (int i = 0; i < 10; ++i) value("a direct ratio");
    read_angles();
    read_candelas(words_, conversion * web_.lamp_flux / 1000, {"intensity at gamma = ", " in plane C = "}, web_,
                  warnings_);
    words_.end(warnings_, [&](std::size_t) {
      words_.refuse(text("more values than ", gammas_, " intensities in each of ", stored_,
                         " planes; the counts or the symmetry do not fit the data"));
    });
    web_.declared_flux = web_.lamp_flux * output_ratio / 100;
    complete_web(web_, web_.declared_flux, false, warnings_);
    return std::move(web_);
  }

 private:
  void read_opening() {
    const double length = value("the length of the luminous area") / 1000;
    const double width = value("its width") / 1000;
    double height = 0;
    for (const char* side : {"C0", "C90", "C180", "C270"})
      height = std::max(height, value(text("the height of the luminous area at ", side)) / 1000);
    // Length lies along C90 to C270, across the planes that see most of a tube. Width 0: round, length the diameter.
    web_.opening.round = width == 0 && length > 0;
    web_.opening.size = {std::abs(web_.opening.round ? length : width), std::abs(length), height};
  }

  void read_lamps() {
    const std::size_t sets = whole("the number of lamp sets", 1, kMostLampSets);
    for (std::size_t set = 0; set < sets; ++set) {
      value("the number of lamps");  // negative: absolute photometry; the flux is then the luminaire's
      skip("the type of lamps");
      const double flux = value("the flux of the lamps");
      for (const char* text : {"the colour of the lamps", "their colour rendering", "their power"}) skip(text);
      if (set > 0) continue;
      if (!(flux > 0))
        words_.refuse(text("the flux of the lamps = ", flux, " lm; the intensities are per 1,000 lm of it"));
      web_.lamp_flux = flux;
    }
    if (sets > 1) warnings_.push_back(text(web_.name, ": has ", sets, " sets of lamps; the first is taken"));
  }

  /// Planes that are stored, of the planes named. Symmetry to C90-C270 stores C270 over C0 to C90.
  void read_angles() {
    std::vector<double> C = ascending(planes_, "C angle", 360);
    web_.vertical = ascending(gammas_, "gamma angle", 180);
    if (symmetry_ != 1 && C.front() != 0)
      words_.refuse(text("the C angles start at ", C.front(), " degrees, not at 0"));
    if (C.size() > 1 && C.back() == 360) words_.refuse("the C angles end at 360 degrees, which is 0 again");
    const auto divisible = [&](std::size_t by) {
      if (planes_ % by != 0)
        words_.refuse(text(planes_, " C planes with symmetry ", symmetry_, "; a multiple of ", by, " is expected"));
    };
    std::size_t from = 0;
    switch (symmetry_) {
      case 0:
        web_.symmetry = WebSymmetry::none;
        stored_ = planes_;
        break;
      case 1:
        web_.symmetry = WebSymmetry::rotational;
        stored_ = 1;
        break;
      case 2:
        web_.symmetry = WebSymmetry::about_0_180;
        divisible(2);
        stored_ = planes_ / 2 + 1;
        break;
      case 3:
        web_.symmetry = WebSymmetry::about_90_270;
        divisible(4);
        stored_ = planes_ / 2 + 1;
        from = 3 * planes_ / 4;
        break;
      default:
        web_.symmetry = WebSymmetry::quadrants;
        divisible(4);
        stored_ = planes_ / 4 + 1;
    }
    if (symmetry_ == 0 && planes_ < 2) words_.refuse("one C plane without symmetry; write symmetry 1");
    for (std::size_t k = 0; k < stored_; ++k) web_.horizontal.push_back(C[(from + k) % planes_]);
  }

  std::vector<double> ascending(std::size_t n, const char* name, double high) {
    std::vector<double> angles;
    const auto what = [&] { return text(name, " ", angles.size() + 1, " of ", n); };
    while (angles.size() < n) {
      const double a = words_.number(what);
      if (a < 0 || a > high) words_.refuse(text(what(), " = ", a, " is outside [0, ", high, "] degrees"));
      if (!angles.empty() && !(a > angles.back()))
        words_.refuse(text(name, "s are not ascending: ", a, " follows ", angles.back()));
      angles.push_back(a);
    }
    return angles;
  }

  void skip(std::string_view what) {
    std::string_view line;
    if (!words_.line(line)) words_.refuse(text("the file ends before ", what));
  }
  double value(std::string_view what) {
    std::string_view line;
    if (!words_.line(line)) words_.refuse(text("the file ends before ", what));
    line = trimmed(line);
    if (line.empty()) return 0;  // what does not apply is left empty
    return words_.checked(line, [&] { return what; });
  }
  std::size_t whole(const char* what, double low, double high) {
    const double x = value(what);
    if (!(x >= low && x <= high && x == std::floor(x)))
      words_.refuse(text(what, " = ", x, "; a whole number in [", low, ", ", high, "] is expected"));
    return static_cast<std::size_t>(x);
  }

  NumberWords words_;
  std::vector<std::string>& warnings_;
  PhotometricWeb web_;
  std::size_t symmetry_ = 0, planes_ = 0, gammas_ = 0, stored_ = 0;
};

}  // namespace

PhotometricWeb parse_ldt(std::string_view bytes, const std::string& name, std::vector<std::string>& warnings) {
  return LdtReader(bytes, name, warnings).read();
}

PhotometricWeb read_ldt(const std::filesystem::path& file, std::vector<std::string>& warnings) {
  return parse_ldt(read_input_file(file, kMaxBytes), short_name(file), warnings);
}

}  // namespace clerestory
