#pragma once
// Data that a page carries for its script, as elements that are not shown.

#include <string>

#include <nlohmann/json.hpp>

namespace clerestory {

/// content  without '<'
std::string embedded_text(const std::string& id, const std::string& content);
/// Nothing in it looks like an end of the element.
std::string embedded_json(const std::string& id, const nlohmann::ordered_json& json);

}  // namespace clerestory
