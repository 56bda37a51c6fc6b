// Any bytes as a sensor file: read, or refused with a message; never anything else.

#include <cmath>

#include "io/read_sensors.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clerestory;
  read_or_refuse([&] {
    for (const SensorPoint& sensor : read_sensors(write_fuzz_input(data, size)).points)
      require(is_finite(sensor.position) && std::abs(length(sensor.normal) - 1) <= 1e-9,
              "a sensor has no place, or no direction of length 1");
  });
  return 0;
}
