// Any bytes as a photometric file: read, or refused with a message; never anything else.

#include <cmath>
#include <cstdlib>
#include <string>

#include "io/formats/photometry.h"
#include "solver/model/error.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clerestory;
  try {
    std::vector<std::string> warnings;
    const PhotometricWeb web = read_photometry(write_fuzz_input(data, size), warnings);
    if (!(web.flux >= 0) || !std::isfinite(web.flux)) std::abort();
    if (web.candela.size() != web.vertical.size() * web.horizontal.size()) std::abort();
    for (const Vec3& d : {Vec3{0, 0, -1}, {0, 0, 1}, {1, 0, 0}, {-0.6, -0.48, 0.64}, {0, -1, 0}})
      if (const double I = candela_towards(web, d); !(I >= 0 && I <= 1.001 * peak_candela(web))) std::abort();
    ++fuzz_tally.read;
  } catch (const InputError& error) {
    if (std::string(error.what()).find('\n') != std::string::npos) std::abort();
    ++fuzz_tally.refused;
  }
  return 0;
}
