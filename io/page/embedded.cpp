#include "io/page/embedded.h"

#include "io/text.h"

namespace clerestory {

std::string embedded_text(const std::string& id, const std::string& content) {
  return text("<script type=\"text/plain\" id=\"", id, "\">", content, "</script>\n");
}

std::string embedded_json(const std::string& id, const nlohmann::ordered_json& json) {
  std::string content;
  for (const char c : json.dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace))
    if (c == '<')
      content += "\\u003c";
    else
      content += c;
  return embedded_text(id, content);
}

}  // namespace clerestory
