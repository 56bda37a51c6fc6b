#include "io/page/solution_data.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "io/page/css_colour.h"
#include "io/page/embedded.h"
#include "io/page/packed.h"
#include "io/text.h"
#include "solver/model/exposure.h"
#include "solver/model/inner_rooms.h"

namespace clerestory {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t kNone = ~std::uint32_t{0};
constexpr int kSteps = 65'535, kColours = 33;
constexpr double kDarkest = 1e-9;  ///< of the largest illuminance; what is darker is shown as dark

/// Triangles room by room, the outdoors last, and points in the order that these need them.
struct Order {
  std::vector<std::uint32_t> triangles;  ///< the result's numbers of them
  std::vector<std::uint32_t> points;     ///< the same of points
  std::vector<std::uint32_t> corners;    ///< three a triangle, distance back from the next new point
  std::vector<std::uint32_t> runs;       ///< four a run
};

Order order_of(const WrittenResult& r) {
  Order order;
  order.triangles.resize(r.triangles.size());
  std::iota(order.triangles.begin(), order.triangles.end(), 0u);
  const std::vector<bool> inner = inner_rooms(r);
  const auto key = [&](std::uint32_t i) {
    return std::tuple(!r.room.empty() && !inner[r.room[i]], r.room.empty() ? 0 : r.room[i], r.surface[i],
                      r.material[i]);
  };
  std::ranges::stable_sort(order.triangles, std::less(), key);
  std::vector<std::uint32_t> number(r.points.size(), kNone);
  for (const std::uint32_t i : order.triangles) {
    for (const std::uint32_t p : r.triangles[i]) {
      const auto next = static_cast<std::uint32_t>(order.points.size());
      if (number[p] == kNone) number[p] = next, order.points.push_back(p);
      order.corners.push_back(next - number[p]);
    }
    const auto [outside, room, surface, material] = key(i);
    const std::size_t n = order.runs.size();
    if (n > 0 && std::tie(order.runs[n - 3], order.runs[n - 2], order.runs[n - 1]) == std::tie(room, surface, material))
      ++order.runs[n - 4];
    else
      order.runs.insert(order.runs.end(), {1, room, surface, material});
  }
  return order;
}

/// Runs of triangles that can be looked at alone: all inside, each room, open air, all.
Json parts_of(const WrittenResult& r, const Order& order) {
  Json parts = Json::array();
  const std::size_t all = order.triangles.size();
  const auto add = [&](const std::string& name, std::size_t begin, std::size_t count) {
    parts.push_back({{"name", clean_text(name)}, {"begin", begin}, {"count", count}});
  };
  const std::vector<bool> inner = inner_rooms(r);
  const auto outside =
      std::ranges::find_if(order.triangles, [&](std::uint32_t i) { return !r.room.empty() && !inner[r.room[i]]; });
  const auto inside = static_cast<std::size_t>(outside - order.triangles.begin());
  if (inside > 0 && inside < all) add("all rooms", 0, inside);
  if (inside == 0 || inside == all) add(r.room.empty() ? "scene" : inside == 0 ? "outdoors" : "all rooms", 0, all);
  for (std::size_t begin = 0; !r.room.empty() && begin < all;) {
    const std::uint32_t room = r.room[order.triangles[begin]];
    std::size_t end = begin;
    while (end < all && r.room[order.triangles[end]] == room) ++end;
    if (end - begin < all) add(r.rooms[room], begin, end - begin);
    begin = end;
  }
  if (inside > 0 && inside < all) add("all, with the outdoors", 0, all);
  return parts;
}

/// Illuminance in even steps of its logarithm: 0 is no light, 1 to kSteps go from low to high [lx].
struct LightSteps {
  double low = 0, high = 0;
  std::vector<std::uint16_t> steps;
};

LightSteps steps_of(const std::vector<float>& lux, const Order& order) {
  double brightest = 0;
  for (const std::uint32_t p : order.points) brightest = std::max(brightest, double{lux[p]});
  double darkest = brightest;
  for (const std::uint32_t p : order.points)
    if (lux[p] > 0) darkest = std::min(darkest, double{lux[p]});
  darkest = std::max(darkest, kDarkest * brightest);
  if (!(brightest > darkest)) brightest = darkest > 0 ? 2 * darkest : 1;
  if (!(darkest > 0)) darkest = brightest / 2;

  LightSteps light{darkest, brightest, {}};
  light.steps.reserve(order.points.size());
  for (const std::uint32_t p : order.points) {
    const double t = std::log(std::max<double>(lux[p], darkest) / darkest) / std::log(brightest / darkest);
    const auto step = 1 + std::lround((kSteps - 1) * std::min(t, 1.0));
    light.steps.push_back(lux[p] < darkest * (1 - 1e-9) ? 0 : static_cast<std::uint16_t>(step));
  }
  return light;
}

/// How much of what leaves each point is the layer's, where the result tells that apart from what arrives.
void add_shares(std::vector<std::uint8_t>& shares, const WrittenResult& r, const std::string& layer,
                const Order& order) {
  const auto B_layer = r.of_points.find(of_layer("radiosity", layer));
  if (B_layer == r.of_points.end()) return;
  const WrittenArray& B = r.of_points.at("radiosity");
  const auto channels = static_cast<std::size_t>(B.components);
  for (const std::uint32_t p : order.points) {
    double part = 0, whole = 0;
    for (std::size_t k = 0; k < channels; ++k)
      part += B_layer->second.value[p * channels + k], whole += B.value[p * channels + k];
    shares.push_back(static_cast<std::uint8_t>(std::lround(whole > 0 ? 255 * std::clamp(part / whole, 0.0, 1.0) : 0)));
  }
}

std::vector<std::uint8_t> shades_of(const WrittenResult& r, const Order& order) {
  const double exposure = exposure_of(r, 0);
  const WrittenArray& B = r.of_points.at("radiosity");
  const auto channels = static_cast<std::size_t>(B.components);
  std::vector<std::uint8_t> shades;
  shades.reserve(order.points.size() * channels);
  for (const std::uint32_t p : order.points)
    for (std::size_t k = 0; k < channels; ++k) shades.push_back(srgb_byte(exposure * B.value[p * channels + k]));
  return shades;
}

template <class Number>
std::string element_of(const char* name, const std::vector<Number>& numbers) {
  return embedded_text(text("solution-", name), packed_by_bytes(std::span<const Number>(numbers)));
}

Json names_of(const std::vector<std::string>& names) {
  Json json = Json::array();
  for (const std::string& name : names) json.push_back(clean_text(name));
  return json;
}

}  // namespace

SolutionData solution_data(const WrittenResult& r, std::span<const double> levels, double low, double high) {
  const Order order = order_of(r);
  const LightSteps light = steps_of(r.of_points.at("illuminance").value, order);
  std::vector<std::uint16_t> layers;
  std::vector<std::uint8_t> shares;
  Json ranges = Json::array();
  for (const ShownLayer& layer : r.around.layers) {
    const LightSteps own = steps_of(r.of_points.at(of_layer("illuminance", layer.name)).value, order);
    layers.insert(layers.end(), own.steps.begin(), own.steps.end());
    ranges.push_back({own.low, own.high});
    add_shares(shares, r, layer.name, order);
  }

  Vec3 least = r.points[order.points[0]], most = least;
  for (const std::uint32_t p : order.points) {
    const Vec3& x = r.points[p];
    least = {std::min(least.x, x.x), std::min(least.y, x.y), std::min(least.z, x.z)};
    most = {std::max(most.x, x.x), std::max(most.y, x.y), std::max(most.z, x.z)};
  }
  const Vec3 centre = (least + most) / 2;

  std::vector<float> positions, panes;
  const auto add_place = [&](std::vector<float>& to, const Vec3& x) {
    const Vec3 d = x - centre;
    to.insert(to.end(), {static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)});
  };
  for (const std::uint32_t p : order.points) add_place(positions, r.points[p]);
  for (const PaneTriangle& pane : r.around.panes)
    for (const Vec3& x : pane.corners) add_place(panes, x);

  Json head = {{"centre", {centre.x, centre.y, centre.z}},
               {"channels", r.of_points.at("radiosity").components},
               {"light", {light.low, light.high}},
               {"range", {low, high}},
               {"levels", std::vector<double>(levels.begin(), levels.end())},
               {"rooms", r.room.empty() ? Json::array() : names_of(r.rooms)},
               {"surfaces", names_of(r.surfaces)},
               {"parts", parts_of(r, order)},
               {"luminaires", Json::array()},
               {"materials", Json::array()},
               {"colours", Json::array()}};
  for (const Material& m : r.materials) head["materials"].push_back(clean_text(m.name));
  for (const ShownLuminaire& l : r.around.luminaires) {
    const Vec3 d = l.position - centre;
    head["luminaires"].push_back({d.x, d.y, d.z});
  }
  for (int i = 0; i < kColours; ++i) head["colours"].push_back(css_colour(i / (kColours - 1.0)));
  if (!layers.empty()) head["layers"] = ranges;
  if (r.around.daylight_reference) head["daylightReference"] = *r.around.daylight_reference;

  SolutionData data;
  for (const Json& part : head["parts"]) data.parts.push_back(part["name"]);
  data.elements = embedded_json("solution-head", head) + element_of("positions", positions) +
                  element_of("light", light.steps) + element_of("shades", shades_of(r, order)) +
                  element_of("corners", order.corners) + element_of("runs", order.runs) + element_of("panes", panes) +
                  element_of("layers", layers) + element_of("shares", shares);
  return data;
}

}  // namespace clerestory
