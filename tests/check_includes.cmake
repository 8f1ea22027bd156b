# Who may include whom (docs/architecture.md), as a test: cmake -P check_includes.cmake
cmake_minimum_required(VERSION 3.25)
get_filename_component(ROOT ${CMAKE_CURRENT_LIST_DIR}/.. ABSOLUTE)

# rule(<files> <ALLOW|DENY> <includes> <reason>): every #include of a file whose path matches
# <files> must (ALLOW) or must not (DENY) match <includes>. Both are regular expressions; an include
# is seen with its quotes or brackets.
set_property(GLOBAL PROPERTY violations "")
file(GLOB_RECURSE sources RELATIVE ${ROOT}
  ${ROOT}/src/*.hpp ${ROOT}/src/*.cpp ${ROOT}/kernels/*.hpp ${ROOT}/kernels/*.inl
  ${ROOT}/kernels/*.cpp ${ROOT}/tests/*.cpp ${ROOT}/tests/*.hpp ${ROOT}/bench/*.cpp
  ${ROOT}/bench/*.hpp)
function(rule files mode includes reason)
  foreach(source IN LISTS sources)
    if(NOT source MATCHES "${files}")
      continue()
    endif()
    file(STRINGS ${ROOT}/${source} lines REGEX "^[ \t]*#[ \t]*include[ \t]")
    foreach(line IN LISTS lines)
      string(REGEX MATCH "[<\"][^>\"]*[>\"]" include "${line}")
      if((mode STREQUAL "ALLOW" AND NOT include MATCHES "${includes}") OR
         (mode STREQUAL "DENY" AND include MATCHES "${includes}"))
        set_property(GLOBAL APPEND_STRING PROPERTY violations
                     "  ${source}: ${include}: ${reason}\n")
      endif()
    endforeach()
  endforeach()
endfunction()

set(std "<[a-z0-9_]+>")  # one word in brackets: the standard library
set(public "<burnish/[a-z0-9_]+\\.hpp>")

# Each library behind one door.
rule("^src/(app|core|geometry|image|include|machine|mesh|models|program|raster|scene|shade|trace|view|pipeline|draw)"
  DENY "<(OpenMesh|OpenImageIO|toml\\+\\+)/" "only src/io may see file formats")
rule("^src/io/([^i]|i[^m])" DENY "<OpenImageIO/" "only src/io/image_io.cpp may")
rule("^src/io/image_io\\.cpp" DENY "<fmt/" "OpenImageIO bundles another fmt")
rule("^(src|tests)/" DENY "<xsimd/" "only the per-ISA build of kernels/ may")
rule("^src/([^a]|app/([^c]|c[^o]|co[^m]|com[^m]))" DENY "<CLI/" "only src/app/command_line.cpp may")
rule("^src/app/.*\\.hpp" DENY "<CLI/" "only src/app/command_line.cpp may")
rule("^src/app/options/" DENY "\"(lab/|app/([^co]|c[^o]|o[^p]|co[^m]|com[^m]))"
  "options are data; what verbs do with it stands beside them")
rule("^src/([^c]|core/[^p])" DENY "<(tbb|oneapi)/" "threads sit behind core/parallel.hpp")

# What users include builds with the standard library and GLM alone.
rule("^src/include/" ALLOW "^(${std}|<glm/.*>|${public})$" "public: std, GLM, <burnish/...>")

# Kernels: the contract is plain data; what is compiled per ISA sees no inline function of others.
set(contract "(packet|packet_stages|log2_steps|texture_stages|tile_stages|stage_list|kernel_table)\\.hpp")
rule("^kernels/${contract}" ALLOW "^(<cstdint>|<cstddef>|\"kernels/${contract}\")$"
  "contract: <cstdint>, <cstddef>, contract")
rule("^src/" DENY "\"kernels/([^pskt]|simd)" "src/ sees the contract only")
rule("^kernels/" DENY "^(<(burnish|glm|fmt)/|\"[^k])" "kernels see neither src/ nor GLM")

# One direction: app -> pipeline -> raster, shade -> geometry -> image, mesh, machine -> core.
rule("^src/app/" DENY "\"(geometry|image|io|kernels|machine|mesh|pipeline|program|raster|reference|scene|shade|trace)[/.]"
  "the command is a user of the library")
rule("^src/core/" DENY "\"(app|geometry|image|io|machine|mesh|models|pipeline|program|raster|reference|scene|shade|trace)[/.]"
  "core knows no stage")
rule("^src/(image/|mesh/|machine/|models/([^e]|e[^r])|program/|scene/)" DENY "\"(app|geometry|io|pipeline|raster|reference|shade|trace)[/.]"
  "data knows no stage")
rule("^src/models/er" DENY "\"(app|geometry|io|pipeline|raster|shade|trace)[/.]"
  "error_estimate draws as users do, and compares with src/reference")
rule("^src/program/" DENY "\"(image|kernels|machine|mesh|models|scene)[/.]"
  "text knows the public data only")
rule("^src/io/" DENY "\"(app|geometry|kernels|pipeline|raster|reference|shade|trace)[/.]" "files know no stage")
rule("^src/geometry/" DENY "\"(app|io|pipeline|raster|reference|shade|trace)[/.]" "later stage")
rule("^src/raster/" DENY "\"(app|io|pipeline|reference|shade|trace)[/.]" "only pipeline.cpp and src/trace know both")
rule("^src/shade/" DENY "\"(app|io|pipeline|raster|reference|trace)[/.]" "only pipeline.cpp and src/trace know both")
rule("^src/reference/" DENY "\"(app|image|io|kernels|machine|mesh|pipeline|program|raster|shade|trace)[/.]"
  "the double renderer shares scenes and the material layer, nothing that shades")
rule("^src/(pipeline|draw)" DENY "\"(app|io|trace)/" "later stage")
rule("^src/metrics/" DENY "\"(app|geometry|image|io|kernels|machine|mesh|models|pipeline|program|raster|reference|scene|shade|trace)[/.]"
  "metrics know pictures only")
rule("^src/[^almv]|^src/(m[^e]|me[^t])" DENY "\"metrics/" "only those who compare pictures")
rule("^src/([^alv]|app/([^be]|b[^y]))" DENY "\"lab/" "what measures the library is above all of it")
rule("^src/view/" DENY "\"(app|geometry|image|io|kernels|machine|mesh|pipeline|program|raster|reference|scene|shade|trace)[/.]"
  "the window is a user of the library, as the command is")
rule("^src/([^av]|app/([^v]|v[^i]))" DENY "\"view/" "only the command opens windows")
rule("^(src/([^v]|v[^i])|tests/[^v])" DENY "<(SDL|imgui|backends/imgui)" "only src/view/ sees windows")
rule("^src/trace/" DENY "\"(app|io|pipeline)[/.]" "beside the renderer, above its stages")
rule("." DENY "\"\\.\\.?/" "paths start at src/ or at the top")

get_property(violations GLOBAL PROPERTY violations)
if(violations)
  message(FATAL_ERROR "includes that docs/architecture.md forbids:\n${violations}")
endif()
