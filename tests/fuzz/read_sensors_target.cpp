// Any bytes as a sensor file: read, or refused with a message; never anything else.

#include <cmath>
#include <cstdlib>

#include "io/read_sensors.h"
#include "solver/model/error.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clerestory;
  try {
    for (const SensorPoint& sensor : read_sensors(write_fuzz_input(data, size)).points) {
      if (!is_finite(sensor.position) || std::abs(length(sensor.normal) - 1) > 1e-9) std::abort();
    }
    ++fuzz_tally.read;
  } catch (const InputError&) {
    ++fuzz_tally.refused;
  }
  return 0;
}
