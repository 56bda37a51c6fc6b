// Any bytes as the answer of the IFC reader: a model whose indices fit, or an exception.

#include <stdexcept>
#include <string>

#include "io/formats/ifc_answer.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clerestory;
  const std::string answer(reinterpret_cast<const char*>(data), size);
  last_ifc_product(answer);
  try {
    const Model model = model_of_ifc_answer(answer, "a.ifc");
    for (const std::uint32_t c : model.polygons.corner)
      require(c < model.polygons.vertices.size(), "a face has a corner that is not there");
    for (const NamedSpace& space : model.spaces)
      for (const std::uint32_t c : space.corner)
        require(c < space.vertices.size(), "a space has a corner that is not there");
    for (const ModelFixture& fixture : model.fixtures)
      require(!fixture.names.empty() && (!fixture.body || *fixture.body < model.surfaces.size()),
              "a fixture has no name, or a housing that is not there");
    ++fuzz_tally.read;
  } catch (const std::runtime_error&) {  // InputError among them
    ++fuzz_tally.refused;
  }
  return 0;
}
