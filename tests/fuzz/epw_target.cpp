// Any bytes as a weather file: read, or refused with a message; never anything else.

#include <cmath>

#include "io/formats/epw.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clerestory;
  read_or_refuse([&] {
    const Weather weather = read_epw(write_fuzz_input(data, size));
    require(!weather.hours.empty() && std::abs(weather.place.latitude_deg) <= 90, "read no hours, or no place");
    for (const WeatherHour& h : weather.hours)
      require(h.direct_normal.value_or(0) >= 0 && h.diffuse_horizontal.value_or(0) >= 0 &&
                  (h.month <= 0 || (h.hour >= 1 && h.hour <= 24)),
              "an hour has negative light, or no number of a day");
  });
  return 0;
}
