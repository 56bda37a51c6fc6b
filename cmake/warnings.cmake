# Warnings of our own code are errors; libraries are included as system headers.
add_library(clerestory_warnings INTERFACE)
target_compile_options(clerestory_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast -Woverloaded-virtual -Werror)
