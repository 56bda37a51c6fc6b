#pragma once
// A glTF 2.0 file as JSON and bytes: container, buffers, accessors. Only the glTF sources include this header, so JSON
// stays inside. Source: Khronos, "glTF 2.0 specification", 2021.

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <nlohmann/json.hpp>

#include "solver/model/vec.h"

namespace clerestory {

class GltfFile {
 public:
  using Json = nlohmann::json;

  /// Reads .gltf or .glb, whichever the bytes are, with its buffers.
  ///
  /// throws  InputError naming the element, here and in all that follows.
  explicit GltfFile(const std::filesystem::path& file);
  GltfFile(const GltfFile&) = delete;
  GltfFile& operator=(const GltfFile&) = delete;

  const std::string& name() const { return name_; }
  const Json& root() const { return root_; }

  /// Member `list` of the root, which must be an array; an empty one when there is none.
  const Json& list(const char* list) const;
  /// Element of a list of the root, named by words such as "meshes[3]" when it is not there.
  const Json& element(const char* list, std::size_t index) const;

  /// Of an accessor, decoded once however often it is used.
  const std::vector<Vec3>& positions(std::size_t accessor);
  std::vector<std::uint32_t> indices(std::size_t accessor);
  /// All components of an accessor of that type ("VEC2"), n of them an element, as numbers.
  std::vector<double> numbers(std::size_t accessor, const char* type, std::size_t n);
  /// What a uri stands for: a data URI, or a file beside the model. Read once, whatever number of times and by whatever
  /// path it is named. `uri` is a text of root().
  std::string_view uri_bytes(const std::string& uri, const std::string& where);
  /// The files beside the model that its uris name, as they are written, percent signs undone.
  std::vector<std::string> file_names() const;
  std::string_view view_bytes(std::size_t buffer_view) const { return view(buffer_view).bytes; }

  /// Takes vertices and corners from what the whole file may grow to, which goes by the bytes it has; refuses when
  /// nothing is left. A mesh that many nodes show counts as often, a vertex that many primitives share too.
  void spend(std::size_t vertices_and_corners, const std::string& where);

  [[noreturn]] void refuse(const std::string& what) const;

 private:
  struct View {
    std::string_view bytes;
    std::size_t stride = 0;  // 0: tightly packed
  };
  View view(std::size_t buffer_view) const;
  std::string_view buffer_bytes(const Json& buffer, std::size_t index, std::string_view binary_chunk);

  std::filesystem::path file_;
  std::string name_, bytes_;
  Json root_;
  std::map<std::filesystem::path, std::string> files_;            // named by uris, by the one path each has
  std::unordered_map<std::string_view, std::string> data_;        // of data URIs, which root_ holds
  std::vector<std::string_view> buffers_;                         // parts of bytes_, files_ and data_
  std::unordered_map<std::size_t, std::vector<Vec3>> positions_;  // by accessor
  std::size_t bytes_read_ = 0, spent_ = 0, unbacked_ = 0;
};

/// A uri with its %20 and the like undone.
std::string percent_decoded(std::string_view uri);
/// Member `key` of an object as a whole number; `otherwise` when it is not there.
std::size_t whole_number(const GltfFile& file, const nlohmann::json& object, const char* key, std::size_t otherwise,
                         const std::string& where);
/// Member `key` as a finite number.
double finite_number(const GltfFile& file, const nlohmann::json& object, const char* key, double otherwise,
                     const std::string& where);
/// Member `key` as n finite numbers; `otherwise` when it is not there.
std::vector<double> finite_numbers(const GltfFile& file, const nlohmann::json& object, const char* key,
                                   std::vector<double> otherwise, const std::string& where);
/// Member `key` as a text; empty when it is not there.
std::string text_member(const GltfFile& file, const nlohmann::json& object, const char* key, const std::string& where);
/// object.extensions.name, or an empty object.
const nlohmann::json& extension(const nlohmann::json& object, const char* name);

}  // namespace clerestory
