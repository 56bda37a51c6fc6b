// Any bytes as a photometric file: read, or refused with a message; never anything else.

#include <cmath>

#include "io/formats/photometry.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clerestory;
  read_or_refuse([&] {
    std::vector<std::string> warnings;
    const PhotometricWeb web = read_photometry(write_fuzz_input(data, size), warnings);
    require(web.flux >= 0 && std::isfinite(web.flux), "the flux is negative or infinite");
    require(web.candela.size() == web.vertical.size() * web.horizontal.size(), "planes lack intensities");
    for (const Vec3& d : {Vec3{0, 0, -1}, {0, 0, 1}, {1, 0, 0}, {-0.6, -0.48, 0.64}, {0, -1, 0}}) {
      const double I = candela_towards(web, d);
      require(I >= 0 && I <= 1.001 * peak_candela(web), "an intensity is negative, or above the peak");
    }
  });
  return 0;
}
