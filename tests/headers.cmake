# Each public header and each contract header of the kernels compiles alone, and the contract leaves
# no symbol in any object that includes it.
function(burnish_compile_alone target)
  set(sources "")
  foreach(header IN LISTS ARGN)
    string(MAKE_C_IDENTIFIER ${header} name)
    set(source ${CMAKE_CURRENT_BINARY_DIR}/headers/${name}.cpp)
    file(CONFIGURE OUTPUT ${source} CONTENT "#include <${header}>\n")
    list(APPEND sources ${source})
  endforeach()
  add_library(${target} OBJECT ${sources})
endfunction()

file(GLOB public_headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/src/include
  ${PROJECT_SOURCE_DIR}/src/include/burnish/*.hpp)
burnish_compile_alone(test_public_headers ${public_headers})
target_link_libraries(test_public_headers PRIVATE burnish)

burnish_compile_alone(test_contract_headers kernels/kernel_table.hpp kernels/packet.hpp
  kernels/packet_stages.hpp kernels/stage_list.hpp kernels/tile_stages.hpp)
target_include_directories(test_contract_headers PRIVATE ${PROJECT_SOURCE_DIR})
add_test(NAME kernel_symbols.contract_headers
  COMMAND ${CMAKE_COMMAND} -DNM=${CMAKE_NM} "-DOBJECTS=$<TARGET_OBJECTS:test_contract_headers>"
    -DALLOWED= -P ${CMAKE_CURRENT_SOURCE_DIR}/check_kernel_symbols.cmake)
