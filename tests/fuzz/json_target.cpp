// Any bytes as JSON: a value with finite numbers that is the same when it is written and read again, or refused.

#include <cmath>

#include <nlohmann/json.hpp>

#include "io/parse_json.h"
#include "tests/fuzz/fuzz_input.h"

namespace clerestory {
namespace {

void require_finite(const nlohmann::json& value) {
  if (value.is_number()) require(std::isfinite(value.get<double>()), "a number is not finite");
  if (value.is_structured())
    for (const nlohmann::json& part : value) require_finite(part);
}

}  // namespace
}  // namespace clerestory

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clerestory;
  read_or_refuse([&] {
    const auto value = parse_json<nlohmann::json>({reinterpret_cast<const char*>(data), size}, "input.json");
    require_finite(value);
    require(parse_json<nlohmann::json>(value.dump(), "dump.json") == value, "written and read again it is another");
  });
  return 0;
}
