# The C library may pick other variants of these functions on another CPU, and other bits with them:
# what can reach an image uses src/core/dmath.hpp. cmake -P check_elementary_functions.cmake
cmake_minimum_required(VERSION 3.25)
get_filename_component(ROOT ${CMAKE_CURRENT_LIST_DIR}/.. ABSOLUTE)
file(GLOB_RECURSE sources RELATIVE ${ROOT} ${ROOT}/src/*.hpp ${ROOT}/src/*.cpp ${ROOT}/kernels/*)
set(names "sin|cos|tan|asin|acos|atan|atan2|exp|exp2|log|log2|log10|pow|cbrt|hypot")
set(violations "")
foreach(source IN LISTS sources)
  # The double-precision renderer and its formulas are meant to be independent of the machine;
  # metrics measure images and make none.
  if(source MATCHES "^src/(reference/|metrics/|models/reflectance\\.cpp$)")
    continue()
  endif()
  file(STRINGS ${ROOT}/${source} calls
    REGEX "(^|[^a-z0-9_])(std|glm)::(${names}|rotate|perspective|uniform_[a-z]+_distribution|normal_distribution) *[(<]")
  foreach(call IN LISTS calls)
    string(STRIP "${call}" call)
    string(APPEND violations "  ${source}: ${call}\n")
  endforeach()
endforeach()
if(violations)
  message(FATAL_ERROR "expected burnish::dmath and fixed sequences, found:\n${violations}")
endif()
