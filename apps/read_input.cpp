#include "apps/read_input.h"

namespace clerestory {

Scene read_input(const std::string& input, ReadOptions options, const Console& console) {
  options.should_stop = [&] { return console.should_stop(); };
  return read_scene(input, options);
}

}  // namespace clerestory
