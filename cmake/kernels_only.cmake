# BURNISH_KERNELS_ONLY: the kernels and their tests, for a system for which none of the other
# packages is installed (preset `neon`). Headers are the same for every architecture, so those of
# this one serve; they get a directory of their own, away from this one's C library.
set(headers ${PROJECT_BINARY_DIR}/packaged_headers)
file(MAKE_DIRECTORY ${headers})
foreach(library IN ITEMS xsimd fmt glm)
  file(CREATE_LINK /usr/include/${library} ${headers}/${library} SYMBOLIC)
endforeach()
add_library(burnish_xsimd INTERFACE)
target_include_directories(burnish_xsimd SYSTEM INTERFACE ${headers})
add_library(fmt::fmt INTERFACE IMPORTED)
target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY)
target_include_directories(fmt::fmt SYSTEM INTERFACE ${headers})

set(BUILD_GMOCK OFF)
set(INSTALL_GTEST OFF)
add_subdirectory(/usr/src/googletest ${PROJECT_BINARY_DIR}/googletest EXCLUDE_FROM_ALL)
target_compile_options(gtest PRIVATE -w)
target_compile_options(gtest_main PRIVATE -w)

# The part of burnish that the tests of the kernels link.
add_library(burnish STATIC src/core/aligned.cpp src/core/cpu.cpp kernels/reference.cpp)
set_source_files_properties(kernels/reference.cpp PROPERTIES COMPILE_OPTIONS -O2)
target_include_directories(burnish PUBLIC src/include PRIVATE src ${PROJECT_SOURCE_DIR})
target_link_libraries(burnish PUBLIC fmt::fmt)
