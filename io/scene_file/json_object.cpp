#include "io/scene_file/json_object.h"

#include <algorithm>

#include "io/scene_file/nearest_name.h"
#include "io/text.h"
#include "io/unit_vector.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

std::string_view type_words(const Json& value) {
  switch (value.type()) {
    case Json::value_t::object:
      return "an object";
    case Json::value_t::array:
      return "an array";
    case Json::value_t::string:
      return "a text";
    case Json::value_t::boolean:
      return "true or false";
    case Json::value_t::null:
      return "null";
    case Json::value_t::number_integer:
    case Json::value_t::number_unsigned:
    case Json::value_t::number_float:
      return "a number";
    default:
      return "something else";
  }
}

}  // namespace

std::string Range::words() const {
  const auto bound = [](double x) {
    if (!std::isfinite(x)) return std::string(x < 0 ? "-inf" : "inf");
    std::string digits = text(x);
    if (const std::size_t plus = digits.find("e+"); plus != digits.npos) digits.erase(plus + 1, 1);  // 1e12
    return digits;
  };
  return text(low_allowed && std::isfinite(low) ? '[' : '(', bound(low), ", ", bound(high),
              high_allowed && std::isfinite(high) ? ']' : ')');
}

void refuse_type(const std::string& place, std::string_view wanted, const Json& got) {
  const std::string shown =
      got.is_structured() ? "" : text(" (", quotable(got.dump(-1, ' ', false, Json::error_handler_t::replace)), ")");
  throw InputError(text(place, " must be ", wanted, ", not ", type_words(got), shown));
}

const Json& as_array(const Json& value, const std::string& place, std::string_view of_what) {
  if (!value.is_array()) refuse_type(place, text("an array of ", of_what), value);
  return value;
}

double checked_number(const Json& value, const std::string& place, const Range& range) {
  if (!value.is_number()) refuse_type(place, "a number", value);
  const double x = value.get<double>();
  if (!range.contains(x)) {
    throw InputError(text(place, " = ", x, " is outside ", range.words(), range.advice.empty() ? "" : "; ",
                          range.advice, range.advice.empty() ? "" : "."));
  }
  return x;
}

JsonObject::JsonObject(const Json& value, std::string where, std::initializer_list<std::string_view> known,
                       std::string_view separator)
    : value_(&value), where_(std::move(where)), separator_(separator) {
  if (!value.is_object()) refuse_type(where_, "an object", value);
  for (const auto& [key, member] : value.items()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    throw InputError(text(where_, separator_, quotable(key), " is not a known key; ",
                          suggestion(key, {known.begin(), known.size()})));
  }
}

const Json& JsonObject::at(std::string_view key) const {
  const auto found = value_->find(key);
  if (found == value_->end()) throw InputError(text(place(key), " is missing"));
  return *found;
}

std::optional<double> JsonObject::number(std::string_view key, const Range& range) const {
  if (!has(key)) return std::nullopt;
  return checked_number(at(key), place(key), range);
}

std::optional<std::string> JsonObject::word(std::string_view key) const {
  if (!has(key)) return std::nullopt;
  if (!at(key).is_string()) refuse_type(place(key), "a text", at(key));
  return at(key).get<std::string>();
}

std::optional<std::string> JsonObject::choice(std::string_view key, std::span<const std::string_view> known) const {
  std::optional<std::string> chosen = word(key);
  if (chosen && std::find(known.begin(), known.end(), *chosen) == known.end()) {
    throw InputError(text(place(key), " '", quotable(*chosen), "' is not known; ", suggestion(*chosen, known)));
  }
  return chosen;
}

std::optional<std::vector<double>> JsonObject::numbers(std::string_view key, std::size_t n, const Range& range) const {
  if (!has(key)) return std::nullopt;
  const Json& array = as_array(at(key), place(key), text(n, " numbers"));
  if (array.size() != n) throw InputError(text(place(key), " has ", array.size(), " values; it needs ", n));
  std::vector<double> values;
  for (const Json& member : array)
    values.push_back(checked_number(member, text(place(key), "[", values.size(), "]"), range));
  return values;
}

std::optional<Vec3> JsonObject::vector(std::string_view key, const Range& range) const {
  const auto v = numbers(key, 3, range);
  return v ? std::optional(Vec3{(*v)[0], (*v)[1], (*v)[2]}) : std::nullopt;
}

std::optional<Vec3> JsonObject::unit_vector(std::string_view key) const {
  const std::optional<Vec3> v = vector(key);
  if (!v) return std::nullopt;
  if (*v == Vec3{}) throw InputError(text(place(key), " = [0, 0, 0] has no direction"));
  return clerestory::unit_vector(*v);
}

std::optional<JsonColour> JsonObject::colour(std::string_view key, const Range& range) const {
  if (!has(key)) return std::nullopt;
  const Json& value = at(key);
  const std::string where = place(key);
  if (!value.is_array()) {
    if (!value.is_number()) refuse_type(where, "a number or an array of one number per channel", value);
    return JsonColour{Spectrum(checked_number(value, where, range)), 0};
  }
  if (value.size() != 1 && value.size() != 3) {
    throw InputError(text(where, " has ", value.size(), " values; it takes a number, or one per channel: 1 or 3"));
  }
  JsonColour colour{Spectrum(checked_number(value[0], value.size() == 1 ? where : where + "[0]", range)),
                    static_cast<int>(value.size())};
  for (std::size_t k = 1; k < value.size(); ++k) {
    colour.value.c[k] = checked_number(value[k], text(where, "[", k, "]"), range);
  }
  return colour;
}

}  // namespace clerestory
