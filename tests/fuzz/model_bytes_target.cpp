// Any bytes as what a child process hands over: a model that fits together, or an exception.

#include <stdexcept>

#include "io/formats/model_bytes.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clerestory;
  try {
    const Model model = from_bytes({reinterpret_cast<const char*>(data), size});
    require(to_bytes(model) == std::string_view(reinterpret_cast<const char*>(data), size), "bytes are lost");
    ++fuzz_tally.read;
  } catch (const std::runtime_error&) {
    ++fuzz_tally.refused;
  }
  return 0;
}
