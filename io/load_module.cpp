#include "io/load_module.h"

#include <filesystem>

#include <dlfcn.h>

#include "io/beside_program.h"

namespace clerestory {

void* module_function(const char* module, const char* symbol) {
  // Beside the program, in the build tree as where it is installed; else where the library was installed.
  for (const std::filesystem::path& folder :
       {beside_program(CLERESTORY_MODULE_FOLDER), std::filesystem::path(CLERESTORY_INSTALLED_MODULE_FOLDER)}) {
    if (void* loaded = dlopen((folder / module).c_str(), RTLD_NOW)) return dlsym(loaded, symbol);
  }
  return nullptr;
}

}  // namespace clerestory
