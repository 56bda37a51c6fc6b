#include "io/formats/image_module.h"

#include <filesystem>

#include <dlfcn.h>

#include "io/beside_program.h"
#include "io/formats/decode_image.h"
#include "io/text.h"

namespace clerestory {

void* image_function(const char* symbol) {
  // Beside the program, in the build tree as where it is installed; else where the library was installed.
  for (const std::filesystem::path& folder :
       {beside_program(CLERESTORY_MODULE_FOLDER), std::filesystem::path(CLERESTORY_INSTALLED_MODULE_FOLDER)}) {
    if (void* module = dlopen((folder / kDecodeImageModule).c_str(), RTLD_NOW)) return dlsym(module, symbol);
  }
  return nullptr;
}

void append_bytes(void* to, const void* bytes, std::size_t n) {
  static_cast<std::string*>(to)->append(static_cast<const char*>(bytes), n);
}

std::string no_image_module() {
  return text("cannot be read: ", kDecodeImageModule, " or what it needs is not installed");
}

}  // namespace clerestory
