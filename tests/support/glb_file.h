#pragma once
// A .glb as a test wants it: its JSON, and accessors of float and of indices as numbers.

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/support/temp_folder.h"

namespace clerestory {

struct GlbFile {
  nlohmann::json json;
  std::string binary;

  explicit GlbFile(const std::string& file) {
    const std::string bytes = read_text(file);
    const auto number = [&](std::size_t at) {
      std::uint32_t n = 0;
      std::memcpy(&n, bytes.data() + at, 4);
      return std::size_t{n};
    };
    if (bytes.substr(0, 4) != "glTF" || number(4) != 2 || number(8) != bytes.size() || bytes.substr(16, 4) != "JSON")
      throw std::runtime_error("no .glb");
    json = nlohmann::json::parse(bytes.substr(20, number(12)));
    const std::size_t binary_at = 20 + number(12);
    if (binary_at < bytes.size()) binary = bytes.substr(binary_at + 8, number(binary_at));
  }

  std::vector<double> numbers(const nlohmann::json& accessor) const {
    const nlohmann::json& a = json["accessors"][accessor.get<std::size_t>()];
    const nlohmann::json& view = json["bufferViews"][a["bufferView"].get<std::size_t>()];
    const std::string type = a["type"];
    const std::size_t n =
        a["count"].get<std::size_t>() * (type == "SCALAR" ? 1 : static_cast<std::size_t>(type[3] - '0'));
    const char* from = binary.data() + view["byteOffset"].get<std::size_t>();
    std::vector<double> values;
    for (std::size_t i = 0; i < n; ++i) {
      if (a["componentType"] == 5126) values.push_back(double{read<float>(from, i)});
      if (a["componentType"] == 5125) values.push_back(read<std::uint32_t>(from, i));
      if (a["componentType"] == 5123) values.push_back(read<std::uint16_t>(from, i));
    }
    return values;
  }
  const nlohmann::json& node(const std::string& name) const {
    for (const nlohmann::json& n : json["nodes"])
      if (n.value("name", "") == name) return n;
    throw std::runtime_error("no node " + name);
  }
  const nlohmann::json& primitive(const std::string& node_name, std::size_t k = 0) const {
    return json["meshes"][node(node_name)["mesh"].get<std::size_t>()]["primitives"][k];
  }

 private:
  template <class T>
  static T read(const char* from, std::size_t i) {
    T value;
    std::memcpy(&value, from + i * sizeof value, sizeof value);
    return value;
  }
};

}  // namespace clerestory
