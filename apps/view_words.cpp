#include "apps/view_words.h"

#include <algorithm>
#include <cmath>

#include "io/text.h"

namespace clerestory {
namespace {

constexpr double kMostPixels = 8192.0 * 8192;
constexpr double kFarthest = 1e12;  // as for models [m]
constexpr std::size_t kMostLevels = 64;
constexpr double kMostLight = 1e15;    // as in scene files
constexpr double kLeastSpread = 1e-9;  // of a scale, to the larger of its ends

std::optional<double> finite(std::string_view word) {
  const auto value = to_number(trimmed(word));
  return value && std::isfinite(*value) ? value : std::nullopt;
}

/// The numbers between separators; nothing when one is none.
std::optional<std::vector<double>> numbers(std::string_view words, char separator) {
  std::vector<double> all;
  for (;;) {
    const std::size_t end = words.find(separator);
    const auto value = finite(words.substr(0, end));
    if (!value) return std::nullopt;
    all.push_back(*value);
    if (end == words.npos) return all;
    words.remove_prefix(end + 1);
  }
}

}  // namespace

Problem read_place(const std::string& words, std::optional<Vec3>& to) {
  const auto n = numbers(words, ',');
  if (!n || n->size() != 3) return quotable(words) + " is not x,y,z in metres, such as 1,2.5,1.6";
  if (std::ranges::any_of(*n, [](double v) { return std::abs(v) > kFarthest; }))
    return quotable(words) + " is farther than 1e12 m";
  to = Vec3{(*n)[0], (*n)[1], (*n)[2]};
  return {};
}

Problem read_size(const std::string& words, int& width, int& height) {
  const auto n = numbers(words, 'x');
  const auto is_whole = [](double v) { return v >= 1 && v <= 65535 && v == std::floor(v); };
  if (!n || n->size() != 2 || !is_whole((*n)[0]) || !is_whole((*n)[1]))
    return quotable(words) + " is not WIDTHxHEIGHT in pixels, whole numbers from 1 to 65535, such as 1920x1080";
  if ((*n)[0] * (*n)[1] > kMostPixels) return quotable(words) + " has more than 67 million pixels";
  width = static_cast<int>((*n)[0]), height = static_cast<int>((*n)[1]);
  return {};
}

Problem read_plan(const std::string& words, std::optional<Cut>& to) {
  const auto height = finite(words);
  if (!height) return quotable(words) + " is not a height in metres, such as 1.2";
  to = Cut{2, *height};
  return {};
}

Problem read_section(const std::string& words, std::optional<Cut>& to) {
  const auto place = words.size() > 2 ? finite(std::string_view(words).substr(2)) : std::nullopt;
  if (!place || words[1] != '=' || (words[0] != 'x' && words[0] != 'y'))
    return quotable(words) + " is not x=METRES or y=METRES, such as x=2.5";
  to = Cut{words[0] == 'x' ? 0 : 1, *place};
  return {};
}

Problem read_range(const std::string& words, std::optional<std::pair<double, double>>& to) {
  const auto n = numbers(words, ':');
  if (!n || n->size() != 2) return quotable(words) + " is not LOW:HIGH, such as 10:1000";
  const double low = (*n)[0], high = (*n)[1], largest = std::max(std::abs(low), std::abs(high));
  if (!(low < high)) return quotable(words) + ": the first is not below the second";
  if (largest > kMostLight || high - low < kLeastSpread * largest)
    return quotable(words) + ": no scale has room for that; ends are up to 1e15 and differ in their first nine digits";
  to = {low, high};
  return {};
}

Problem read_levels(const std::string& words, std::vector<double>& to) {
  const auto n = numbers(words, ',');
  if (!n) return quotable(words) + " is not numbers with commas between, such as 100,300,500";
  if (n->size() > kMostLevels) return text("more than ", kMostLevels, " lines");
  to = *n;
  std::ranges::sort(to);
  to.erase(std::unique(to.begin(), to.end()), to.end());
  return {};
}

Problem problem_with_view(const ViewRequest& r, bool as_exr) {
  if (r.eye.has_value() != r.target.has_value())
    return r.eye ? "--eye needs --target, what it looks at" : "--target needs --eye, from where";
  if (r.eye && *r.eye == *r.target) return "--eye and --target are the same place; look at another";
  if (r.up && *r.up == Vec3{}) return "--up 0,0,0 is no direction";
  if (r.fisheye && r.is_drawing()) return "--fisheye needs --eye and --target, or --camera";
  if (r.fisheye && r.fov) return "--fisheye shows 180 degrees; leave --fov out";
  if (r.fov && r.is_drawing()) return "--fov goes with --eye and --target, or --camera";
  if (r.up && r.is_drawing()) return "--up goes with --eye and --target, or --camera";
  if (!r.scene.empty() && r.camera.empty() && !r.wants_lights())
    return "--scene is for --camera, --raytrace and --final-gather: the light of a result needs no scene";
  const bool has_scale = !r.shows_colour();
  if (r.range && !has_scale) return "--range is of false colours; name a quantity: --show illuminance";
  if (r.log_scale && !has_scale) return "--log-scale is of false colours; name a quantity: --show illuminance";
  if (r.log_scale && r.range && !(r.range->first > 0)) return "--log-scale needs a --range above 0";
  if (as_exr && (r.range || r.log_scale || !r.isolux.empty() || r.ev != 0))
    return "an EXR holds the values themselves; --range, --log-scale, --isolux and --exposure are of PNG pictures";
  if (r.ev != 0 && has_scale) return "--exposure is of true colours; leave --show out";
  return {};
}

}  // namespace clerestory
