// Any bytes as the answer of the IFC reader: a model whose indices fit, or an exception with a message.

#include <cstdlib>
#include <stdexcept>
#include <string>

#include "io/formats/ifc_answer.h"
#include "solver/model/error.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clerestory;
  const std::string answer(reinterpret_cast<const char*>(data), size);
  write_fuzz_input(data, size);
  last_ifc_product(answer);
  try {
    const Model model = model_of_ifc_answer(answer, "a.ifc");
    for (const std::uint32_t c : model.polygons.corner)
      if (c >= model.polygons.vertices.size()) std::abort();
    for (const NamedSpace& space : model.spaces)
      for (const std::uint32_t c : space.corner)
        if (c >= space.vertices.size()) std::abort();
    for (const ModelFixture& fixture : model.fixtures)
      if (fixture.names.empty() || (fixture.body && *fixture.body >= model.surfaces.size())) std::abort();
    ++fuzz_tally.read;
  } catch (const std::runtime_error&) {  // InputError among them
    ++fuzz_tally.refused;
  }
  return 0;
}
