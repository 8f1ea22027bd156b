# Every package comes from the system. What each one saves us: docs/architecture.md.
find_package(Threads REQUIRED)
find_package(glm REQUIRED CONFIG)
find_package(fmt REQUIRED CONFIG)
find_package(CLI11 REQUIRED CONFIG)
find_package(OpenMesh REQUIRED CONFIG)
find_package(tomlplusplus REQUIRED CONFIG)
if(BURNISH_THREADS STREQUAL "tbb")
  find_package(TBB REQUIRED CONFIG)
endif()
if(BURNISH_TESTS)
  find_package(GTest REQUIRED)
endif()
if(BURNISH_BENCH)
  find_package(benchmark REQUIRED CONFIG)
endif()

# Headers only: Debian's target also names a library, xtl, that no package ships.
find_package(xsimd 8.1 REQUIRED CONFIG)
get_target_property(xsimd_include xsimd INTERFACE_INCLUDE_DIRECTORIES)
add_library(burnish_xsimd INTERFACE)
target_include_directories(burnish_xsimd SYSTEM INTERFACE ${xsimd_include})

# OpenImageIO's CMake package insists on its command-line tools, on Imath's Python parts and on the
# headers of OpenCV, none of which come with the library or are needed here.
find_path(OPENIMAGEIO_INCLUDE_DIR OpenImageIO/imageio.h REQUIRED)
find_library(OPENIMAGEIO_LIBRARY OpenImageIO REQUIRED)
find_library(OPENIMAGEIO_UTIL_LIBRARY OpenImageIO_Util REQUIRED)
mark_as_advanced(OPENIMAGEIO_INCLUDE_DIR OPENIMAGEIO_LIBRARY OPENIMAGEIO_UTIL_LIBRARY)
add_library(OpenImageIO::OpenImageIO UNKNOWN IMPORTED)
set_target_properties(OpenImageIO::OpenImageIO PROPERTIES
  IMPORTED_LOCATION ${OPENIMAGEIO_LIBRARY}
  INTERFACE_INCLUDE_DIRECTORIES ${OPENIMAGEIO_INCLUDE_DIR}
  INTERFACE_LINK_LIBRARIES ${OPENIMAGEIO_UTIL_LIBRARY})

# Dear ImGui comes as a static library without a CMake package; its headers include each other
# without their directory.
if(BURNISH_VIEW)
  find_package(SDL2 REQUIRED CONFIG)
  find_path(IMGUI_INCLUDE_DIR imgui.h PATH_SUFFIXES imgui REQUIRED)
  find_library(IMGUI_LIBRARY imgui REQUIRED)
  find_library(STB_LIBRARY stb REQUIRED)
  find_library(FREETYPE_LIBRARY freetype REQUIRED)
  mark_as_advanced(IMGUI_INCLUDE_DIR IMGUI_LIBRARY STB_LIBRARY FREETYPE_LIBRARY)
  add_library(burnish_imgui INTERFACE)
  target_include_directories(burnish_imgui SYSTEM INTERFACE ${IMGUI_INCLUDE_DIR})
  target_link_libraries(burnish_imgui INTERFACE ${IMGUI_LIBRARY} ${STB_LIBRARY}
                                                ${FREETYPE_LIBRARY} SDL2::SDL2)
endif()
