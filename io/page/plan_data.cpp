#include "io/page/plan_data.h"

#include "io/page/css_colour.h"
#include "io/page/embedded.h"
#include "io/page/packed.h"
#include "io/text.h"

namespace clerestory {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

std::string layer_sliders(std::span<const std::string> layers) {
  constexpr int kColours = 64;
  Json colours = Json::array();
  for (int i = 0; i < kColours; ++i) colours.push_back(css_colour(i / (kColours - 1.0)));
  std::string out =
      "<noscript><style>#layers { display: none; }</style></noscript>\n<div id=\"layers\" class=\"bar\">\n<strong>Light"
      "</strong>\n";
  for (const std::string& layer : layers)
    out +=
        text("<label>", xml_text(layer), " <input type=\"range\" name=\"", xml_text(layer),
             "\" min=\"0\" max=\"150\" step=\"1\" value=\"100\" autocomplete=\"off\"><output>100 %</output></label>\n");
  return out +
         "<button type=\"button\" id=\"layers-solved\">As in the result</button> <button type=\"button\" "
         "id=\"layers-off\">All "
         "off</button>\n<p id=\"layers-now\" aria-live=\"polite\"></p>\n</div>\n" +
         embedded_json("layers-head", {{"colours", colours}});
}

std::string plan_data(const Plan& plan, std::size_t number, const std::string& name, std::optional<std::size_t> set) {
  if (plan.layers.empty()) return {};
  Json head = {{"low", plan.lowest}, {"high", plan.highest}, {"log", plan.by_logarithm}, {"name", clean_text(name)}};
  if (plan.lattice) head["columns"] = plan.lattice->columns, head["rows"] = plan.lattice->rows;
  if (plan.target) head["target"] = *plan.target;
  if (set) head["set"] = *set;
  return embedded_json(text("plan-", number, "-head"), head) +
         embedded_text(text("plan-", number, "-light"), packed_by_bytes(std::span<const float>(plan.layers)));
}

}  // namespace clerestory
