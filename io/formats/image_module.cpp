#include "io/formats/image_module.h"

#include "io/formats/decode_image.h"
#include "io/load_module.h"
#include "io/text.h"

namespace clerestory {

void* image_function(const char* symbol) { return module_function(kDecodeImageModule, symbol); }

void append_bytes(void* to, const void* bytes, std::size_t n) {
  static_cast<std::string*>(to)->append(static_cast<const char*>(bytes), n);
}

std::string no_image_module() {
  return text("cannot be read: ", kDecodeImageModule, " or what it needs is not installed");
}

}  // namespace clerestory
