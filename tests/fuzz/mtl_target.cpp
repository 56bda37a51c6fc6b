// Any bytes as a material file of a Wavefront model: read, or refused with a message; never anything else.

#include <cmath>

#include "io/formats/mtl.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clerestory;
  read_or_refuse([&] {
    Model model;
    for (const ModelMaterial& m : MtlReader(model).read(write_fuzz_input(data, size))) {
      const Material& material = m.material;
      require(material.reflectance.min() >= 0 && std::isfinite(material.reflectance.max()),
              "a reflectance is negative or infinite");
      require(material.transmittance.min() >= 0 && material.transmittance.max() <= 1,
              "a transmittance is outside [0, 1]");
      require(material.exitance.min() >= 0 && std::isfinite(material.exitance.max()),
              "an exitance is negative or infinite");
    }
  });
  return 0;
}
