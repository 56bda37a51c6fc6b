// Any bytes as a weather file: read, or refused with a message; never anything else.

#include <cmath>
#include <cstdlib>
#include <string>

#include "io/formats/epw.h"
#include "solver/model/error.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clerestory;
  try {
    const Weather weather = read_epw(write_fuzz_input(data, size));
    if (weather.hours.empty() || !(std::abs(weather.place.latitude_deg) <= 90)) std::abort();
    for (const WeatherHour& h : weather.hours)
      if (!(h.direct_normal.value_or(0) >= 0) || !(h.diffuse_horizontal.value_or(0) >= 0) ||
          (h.month > 0 && (h.hour < 1 || h.hour > 24)))
        std::abort();
    ++fuzz_tally.read;
  } catch (const InputError& error) {
    if (std::string(error.what()).find('\n') != std::string::npos) std::abort();
    ++fuzz_tally.refused;
  }
  return 0;
}
