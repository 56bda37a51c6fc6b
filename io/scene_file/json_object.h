#pragma once
// JSON objects read strictly: every value has a place that messages name, a type and a range, and a key that nobody
// reads is an error. Only the sources of this folder include this header, so JSON stays inside.

#include <array>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "solver/model/channels.h"
#include "solver/model/vec.h"

namespace clerestory {

using Json = nlohmann::ordered_json;  // the order of material rules counts

/// Allowed numbers, and what to tell people who step outside.
struct Range {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  bool low_allowed = true, high_allowed = true;
  std::string_view advice{};

  bool contains(double x) const {
    return std::isfinite(x) && (low_allowed ? x >= low : x > low) && (high_allowed ? x <= high : x < high);
  }
  std::string words() const;  ///< "[0, 1)"
};

inline constexpr Range kFinite{};
/// Of positions and lengths in a scene, as of the corners of models and the rows of sensor files.
inline constexpr Range kCoordinate{.low = -1e12, .high = 1e12, .advice = "positions are in metres"};
/// Of every quantity of light in its own unit: what is more is a mistake, and would not fit into the result's floats.
inline constexpr double kMostLight = 1e15;

/// One colour as it was written: a number, or an array of one value per channel.
struct JsonColour {
  Spectrum value;
  int array_length = 0;  ///< 0: a plain number, which goes with any number of channels
};

class JsonObject {
 public:
  /// where   words that lead to this object, "office.json: sky"; members are called where.key.
  /// throws  InputError when `value` is no object, or has a key that is not among `known`.
  JsonObject(const Json& value, std::string where, std::initializer_list<std::string_view> known,
             std::string_view separator = ".");

  bool has(std::string_view key) const { return value_->contains(key); }
  std::string place(std::string_view key) const { return where_ + separator_ + std::string(key); }
  const std::string& where() const { return where_; }

  /// The raw member, which must be there.
  const Json& at(std::string_view key) const;

  std::optional<double> number(std::string_view key, const Range& range = kFinite) const;
  std::optional<std::string> word(std::string_view key) const;
  /// A word that must be one of `known`.
  std::optional<std::string> choice(std::string_view key, std::span<const std::string_view> known) const;
  std::optional<Vec3> vector(std::string_view key, const Range& range = kFinite) const;
  std::optional<Vec3> unit_vector(std::string_view key) const;
  std::optional<JsonColour> colour(std::string_view key, const Range& range) const;
  /// Exactly n numbers.
  std::optional<std::vector<double>> numbers(std::string_view key, std::size_t n, const Range& range = kFinite) const;

 private:
  const Json* value_;
  std::string where_, separator_;
};

/// throws InputError: "office.json: sky.model must be a text, not a number (3)".
[[noreturn]] void refuse_type(const std::string& place, std::string_view wanted, const Json& got);

/// `value` as an array, or InputError.
const Json& as_array(const Json& value, const std::string& place, std::string_view of_what);

double checked_number(const Json& value, const std::string& place, const Range& range);

}  // namespace clerestory
