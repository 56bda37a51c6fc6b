#include "io/formats/gltf_file.h"

#include <bit>
#include <cmath>
#include <cstring>

#include "io/input_file.h"
#include "io/parse_json.h"
#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

using Json = nlohmann::json;

constexpr std::uintmax_t kMaxBytes = 4ull << 30;
// What all accessors of a file may expand to: so much for nothing, and so much for each byte of the file and its
// buffers.
constexpr std::size_t kFreeElements = 24'000'000, kElementsPerByte = 4;
// Of elements that no buffer pays for; zeros that only a sparse accessor makes any use of.
constexpr std::size_t kFreeUnbacked = 1'000'000, kBytesPerUnbacked = 16;
constexpr std::uint32_t kGlbMagic = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;

static_assert(std::endian::native == std::endian::little, "glTF numbers are little-endian");

template <class T>
T read_as(std::string_view bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

struct Chunks {
  std::string_view json, binary;
};

Chunks split_glb(std::string_view bytes, const std::string& name) {
  if (bytes.size() < 20)
    throw InputError(text(name, ": is cut off: a .glb file has at least 20 bytes, this one ", bytes.size()));
  const auto version = read_as<std::uint32_t>(bytes, 4), length = read_as<std::uint32_t>(bytes, 8);
  if (version != 2) throw InputError(text(name, ": is glTF version ", version, "; only version 2 is read"));
  if (length > bytes.size()) {
    throw InputError(text(name, ": is cut off: it has ", bytes.size(), " of ", length, " bytes"));
  }
  Chunks chunks;
  for (std::size_t at = 12; at + 8 <= length;) {
    const auto size = read_as<std::uint32_t>(bytes, at), kind = read_as<std::uint32_t>(bytes, at + 4);
    at += 8;
    if (size > length - at)
      throw InputError(text(name, ": a chunk of ", size, " bytes reaches beyond the end of the file"));
    if (kind == kJsonChunk && chunks.json.empty()) chunks.json = bytes.substr(at, size);
    if (kind == kBinaryChunk && chunks.binary.empty()) chunks.binary = bytes.substr(at, size);
    at += size + (4 - size % 4) % 4;
  }
  if (chunks.json.empty()) throw InputError(text(name, ": has no JSON chunk"));
  return chunks;
}

/// Bytes of base64 text; false when it is something else.
bool decode_base64(std::string_view in, std::string& out) {
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : in) {
    if (c == '=') break;
    const char* alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char* digit = c ? std::strchr(alphabet, c) : nullptr;
    if (!digit) return false;
    bits = (bits << 6 | static_cast<std::uint32_t>(digit - alphabet)) & 0xffffff;
    held += 6;
    if (held >= 8) {
      held -= 8;
      out += static_cast<char>(bits >> held & 0xff);
    }
  }
  return true;
}

std::size_t size_of_component(std::size_t type) {
  switch (type) {
    case 5120:
    case 5121:
      return 1;
    case 5122:
    case 5123:
      return 2;
    case 5125:
    case 5126:
      return 4;
    default:
      return 0;
  }
}

double component(std::string_view bytes, std::size_t at, std::size_t type, bool normalized) {
  switch (type) {
    case 5120:
      return normalized ? std::max(read_as<std::int8_t>(bytes, at) / 127.0, -1.0) : read_as<std::int8_t>(bytes, at);
    case 5121:
      return read_as<std::uint8_t>(bytes, at) / (normalized ? 255.0 : 1.0);
    case 5122:
      return normalized ? std::max(read_as<std::int16_t>(bytes, at) / 32767.0, -1.0) : read_as<std::int16_t>(bytes, at);
    case 5123:
      return read_as<std::uint16_t>(bytes, at) / (normalized ? 65535.0 : 1.0);
    case 5125:
      return read_as<std::uint32_t>(bytes, at);
    default:
      return double{read_as<float>(bytes, at)};
  }
}

}  // namespace

GltfFile::GltfFile(const std::filesystem::path& file) : file_(file), name_(short_name(file)) {
  bytes_ = read_input_file(file, kMaxBytes);
  bytes_read_ = bytes_.size();
  const bool is_binary = bytes_.size() >= 4 && read_as<std::uint32_t>(bytes_, 0) == kGlbMagic;
  if (!is_binary && to_lower(file.extension().string()) == ".glb") {
    refuse("does not start like a .glb file; is it damaged, or another format?");
  }
  const Chunks chunks = is_binary ? split_glb(bytes_, name_) : Chunks{bytes_, {}};
  root_ = parse_json<Json>(chunks.json, name_, {.deepest = 128, .most_keys = 1'000'000});
  if (!is_binary) bytes_.clear();
  if (!root_.is_object()) refuse("is JSON, but not glTF");
  const auto asset = root_.find("asset");
  if (asset == root_.end() || !asset->is_object()) refuse("is JSON, but not glTF: it has no \"asset\"");
  if (const std::string version = text_member(*this, *asset, "version", "asset"); !version.starts_with("2")) {
    refuse(text("is glTF version '", quotable(version), "'; only version 2 is read"));
  }
  std::size_t n = 0;
  for (const Json& buffer : list("buffers")) {
    buffers_.push_back(buffer_bytes(buffer, n, chunks.binary));
    ++n;
  }
}

void GltfFile::refuse(const std::string& what) const { throw InputError(name_ + ": " + what); }

const Json& GltfFile::list(const char* key) const {
  static const Json kNone = Json::array();
  const auto found = root_.find(key);
  if (found == root_.end()) return kNone;
  if (!found->is_array()) refuse(text(key, " must be an array"));
  return *found;
}

const Json& GltfFile::element(const char* key, std::size_t index) const {
  const Json& all = list(key);
  if (index >= all.size()) refuse(text(key, "[", index, "] is used, but there are ", all.size(), " ", key));
  if (!all[index].is_object()) refuse(text(key, "[", index, "] must be an object"));
  return all[index];
}

std::string_view GltfFile::uri_bytes(const std::string& uri, const std::string& where) {
  if (uri.starts_with("data:")) {
    const auto [at, is_new] = data_.try_emplace(uri);
    const std::size_t comma = uri.find(";base64,");
    if (is_new && (comma == uri.npos || !decode_base64(std::string_view(uri).substr(comma + 8), at->second))) {
      refuse(where + ": its data URI is not base64");
    }
    return at->second;
  }
  if (uri.find("://") != uri.npos)
    refuse(text(where, " '", quotable(uri), "' is on the net; only files beside the model are read"));
  const std::filesystem::path file = file_.parent_path() / percent_decoded(uri);
  std::error_code unknown;  // then read_input_file says what is wrong
  const auto [at, is_new] = files_.try_emplace(std::filesystem::weakly_canonical(file, unknown));
  try {
    if (is_new) {
      at->second = read_input_file(file, kMaxBytes);
      bytes_read_ += at->second.size();
    }
    return at->second;
  } catch (const InputError& error) {
    refuse(text(where, ": ", error.what()));
  }
}

std::vector<std::string> GltfFile::file_names() const {
  std::vector<std::string> names;
  std::vector<const Json*> open{&root_};
  while (!open.empty()) {
    const Json& at = *open.back();
    open.pop_back();
    for (const auto& [key, value] : at.items()) {
      if (value.is_structured()) open.push_back(&value);
      if (key != "uri" || !value.is_string()) continue;
      if (const auto& uri = value.get_ref<const std::string&>(); !uri.starts_with("data:"))
        names.push_back(percent_decoded(uri));
    }
  }
  return names;
}

std::string_view GltfFile::buffer_bytes(const Json& buffer, std::size_t index, std::string_view binary_chunk) {
  const std::string where = text("buffers[", index, "]");
  if (!buffer.is_object()) refuse(where + " must be an object");
  const std::size_t length = whole_number(*this, buffer, "byteLength", 0, where);
  const auto uri = buffer.find("uri");
  if (uri != buffer.end() && !uri->is_string()) refuse(where + ".uri must be a text");
  std::string_view bytes;
  if (uri == buffer.end() || uri->get_ref<const std::string&>().empty()) {
    if (index != 0 || binary_chunk.empty()) refuse(where + " has neither a uri nor a binary chunk");
    bytes = binary_chunk;
  } else {
    bytes = uri_bytes(uri->get_ref<const std::string&>(), where);
  }
  if (bytes.size() < length) refuse(text(where, " has ", bytes.size(), " of ", length, " bytes; the file is cut off"));
  return bytes;
}

GltfFile::View GltfFile::view(std::size_t index) const {
  const Json& json = element("bufferViews", index);
  const std::string where = text("bufferViews[", index, "]");
  if (!extension(json, "EXT_meshopt_compression").empty())
    refuse(where + " is compressed (meshopt); export the model without compression");
  const std::size_t buffer = whole_number(*this, json, "buffer", 0, where);
  if (buffer >= buffers_.size())
    refuse(text(where, " uses buffers[", buffer, "], but there are ", buffers_.size(), " buffers"));
  const std::size_t offset = whole_number(*this, json, "byteOffset", 0, where);
  const std::size_t length = whole_number(*this, json, "byteLength", 0, where);
  const std::string_view bytes = buffers_[buffer];
  if (offset > bytes.size() || length > bytes.size() - offset) {
    refuse(text(where, " reaches beyond buffers[", buffer, "] of ", bytes.size(), " bytes"));
  }
  const std::size_t stride = whole_number(*this, json, "byteStride", 0, where);
  if (stride > 252) refuse(text(where, ".byteStride = ", stride, " is outside [4, 252]"));
  return {bytes.substr(offset, length), stride};
}

void GltfFile::spend(std::size_t vertices_and_corners, const std::string& where) {
  spent_ += vertices_and_corners;
  const std::size_t most = kFreeElements + kElementsPerByte * bytes_read_;
  if (spent_ <= most) return;
  refuse(
      text(where, ": with it the file's ", bytes_read_, " bytes make more than ", most,
           " vertices and corners, the most for that size; export parts that repeat less often, or with less detail"));
}

std::vector<double> GltfFile::numbers(std::size_t index, const char* type, std::size_t n) {
  const Json& json = element("accessors", index);
  const std::string where = text("accessors[", index, "]");
  if (text_member(*this, json, "type", where) != type) refuse(text(where, ".type must be ", type, " for this use"));
  const std::size_t count = whole_number(*this, json, "count", 0, where);
  const auto normalized = json.find("normalized");
  const bool is_normalized = normalized != json.end() && normalized->is_boolean() && normalized->get<bool>();

  const auto copy = [&](const Json& from, std::size_t component_type, std::size_t parts, std::size_t elements,
                        bool fractions, const std::string& place, std::vector<double>& to) {
    const View source = view(whole_number(*this, from, "bufferView", 0, place));
    const std::size_t offset = whole_number(*this, from, "byteOffset", 0, place);
    const std::size_t size = size_of_component(component_type);
    if (size == 0) refuse(text(place, ".componentType = ", component_type, " is not known"));
    const std::size_t stride = source.stride > 0 ? source.stride : size * parts;
    const std::size_t bytes = source.bytes.size();
    if (elements > 0 &&
        (offset > bytes || size * parts > bytes - offset || elements - 1 > (bytes - offset - size * parts) / stride)) {
      refuse(text(place, " needs ", elements, " elements, more than its bufferView of ", bytes, " bytes holds"));
    }
    spend(elements, place);
    to.reserve(elements * parts);
    for (std::size_t e = 0; e < elements; ++e) {
      for (std::size_t k = 0; k < parts; ++k) {
        to.push_back(component(source.bytes, offset + e * stride + k * size, component_type, fractions));
      }
    }
  };

  const std::size_t component_type = whole_number(*this, json, "componentType", 0, where);
  std::vector<double> values;
  if (json.contains("bufferView")) {
    copy(json, component_type, n, count, is_normalized, where, values);
  } else {
    const std::size_t most = kFreeUnbacked + bytes_read_ / kBytesPerUnbacked;
    if (count > most - unbacked_) {
      refuse(text(where, " has ", count, " elements and no bufferView, which makes more than ", most,
                  " of such in this file; export it with its data"));
    }
    unbacked_ += count;
    spend(count, where);
    values.assign(count * n, 0.0);
  }
  const auto sparse = json.find("sparse");
  if (sparse != json.end()) {
    const std::string place = where + ".sparse";
    if (!sparse->is_object() || !sparse->contains("indices") || !sparse->contains("values"))
      refuse(place + " lacks indices or values");
    const std::size_t changed = whole_number(*this, *sparse, "count", 0, place);
    if (changed > count) refuse(text(place, ".count = ", changed, " is more than the accessor's ", count));
    const Json& at = (*sparse)["indices"];
    if (!at.is_object() || !(*sparse)["values"].is_object()) refuse(place + " lacks indices or values");
    std::vector<double> where_to, what;
    copy(at, whole_number(*this, at, "componentType", 0, place), 1, changed, false, place + ".indices", where_to);
    copy((*sparse)["values"], component_type, n, changed, is_normalized, place + ".values", what);
    for (std::size_t i = 0; i < changed; ++i) {
      if (!(where_to[i] >= 0 && where_to[i] < static_cast<double>(count)))
        refuse(text(place, ": index ", where_to[i], " is outside [0, ", count, ")"));
      for (std::size_t k = 0; k < n; ++k) values[static_cast<std::size_t>(where_to[i]) * n + k] = what[i * n + k];
    }
  }
  return values;
}

const std::vector<Vec3>& GltfFile::positions(std::size_t accessor) {
  const auto [at, is_new] = positions_.try_emplace(accessor);
  if (!is_new) return at->second;
  const std::vector<double> values = numbers(accessor, "VEC3", 3);
  std::vector<Vec3>& points = at->second;
  points.resize(values.size() / 3);
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
  return points;
}

std::vector<std::uint32_t> GltfFile::indices(std::size_t accessor) {
  const std::vector<double> values = numbers(accessor, "SCALAR", 1);
  std::vector<std::uint32_t> at;
  at.reserve(values.size());
  for (const double value : values) {
    // Also says no to NaN, when the indices are stored as float.
    if (!(value >= 0 && value <= 4294967295.0))
      refuse(text("accessors[", accessor, "] holds ", value, ", which is no vertex index"));
    at.push_back(static_cast<std::uint32_t>(value));
  }
  return at;
}

std::string percent_decoded(std::string_view uri) {
  const auto hex = [](char c) {
    return c >= '0' && c <= '9' ? c - '0' : (c | 32) >= 'a' && (c | 32) <= 'f' ? (c | 32) - 'a' + 10 : -1;
  };
  std::string path;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const int high = uri[i] == '%' && i + 2 < uri.size() ? hex(uri[i + 1]) : -1;
    const int low = high >= 0 ? hex(uri[i + 2]) : -1;
    if (low >= 0) {
      path += static_cast<char>(high * 16 + low);
      i += 2;
    } else {
      path += uri[i];
    }
  }
  return path;
}

std::size_t whole_number(const GltfFile& file, const Json& object, const char* key, std::size_t otherwise,
                         const std::string& where) {
  const auto found = object.find(key);
  if (found == object.end()) return otherwise;
  if (!found->is_number_unsigned()) {
    // 3.0 is a whole number as well
    const double value = found->is_number() ? found->get<double>() : -1;
    if (!(value >= 0 && value < 9e15 && value == std::floor(value)))
      file.refuse(text(where, ".", key, " must be a whole number, 0 or more"));
    return static_cast<std::size_t>(value);
  }
  return found->get<std::size_t>();
}

double finite_number(const GltfFile& file, const Json& object, const char* key, double otherwise,
                     const std::string& where) {
  const auto found = object.find(key);
  if (found == object.end()) return otherwise;
  if (!found->is_number() || !std::isfinite(found->get<double>()))
    file.refuse(text(where, ".", key, " must be a number"));
  return found->get<double>();
}

std::vector<double> finite_numbers(const GltfFile& file, const Json& object, const char* key,
                                   std::vector<double> otherwise, const std::string& where) {
  const auto found = object.find(key);
  if (found == object.end()) return otherwise;
  std::vector<double> values;
  if (found->is_array()) {
    for (const Json& value : *found) {
      if (value.is_number() && std::isfinite(value.get<double>())) values.push_back(value.get<double>());
    }
  }
  if (values.size() != otherwise.size() || found->size() != otherwise.size()) {
    file.refuse(text(where, ".", key, " must be ", otherwise.size(), " numbers"));
  }
  return values;
}

std::string text_member(const GltfFile& file, const Json& object, const char* key, const std::string& where) {
  const auto found = object.find(key);
  if (found == object.end()) return {};
  if (!found->is_string()) file.refuse(text(where, ".", key, " must be a text"));
  return found->get<std::string>();
}

const Json& extension(const Json& object, const char* name) {
  static const Json kNone = Json::object();
  const auto all = object.find("extensions");
  if (all == object.end() || !all->is_object()) return kNone;
  const auto found = all->find(name);
  return found != all->end() && found->is_object() ? *found : kNone;
}

}  // namespace clerestory
