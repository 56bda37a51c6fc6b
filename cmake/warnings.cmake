# Warnings of our own code are errors, but those of clang, which compiles the fuzz targets only; libraries are included as
# system headers.
add_library(clerestory_warnings INTERFACE)
target_compile_options(clerestory_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast -Woverloaded-virtual $<$<CXX_COMPILER_ID:GNU>:-Werror>)
# GCC 12 takes "text" + std::string for overlapping copies (bug 105651).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(clerestory_warnings INTERFACE -Wno-restrict)
  # With <string> precompiled it no longer knows the system's header, and takes such copies for too long as well.
  if(NOT CMAKE_DISABLE_PRECOMPILE_HEADERS)
    target_compile_options(clerestory_warnings INTERFACE -Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread)
  endif()
endif()
