# solver/model/version.h, for the program and for users of the library.
configure_file(${CMAKE_CURRENT_LIST_DIR}/version.h.in ${PROJECT_BINARY_DIR}/generated/solver/model/version.h @ONLY)
target_include_directories(clerestory_model PUBLIC $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/generated>)
