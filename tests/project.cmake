# Tests of the project rather than of its code: headers, rules about sources, the package.
#
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
  kernels/log2_steps.hpp kernels/packet_stages.hpp kernels/stage_list.hpp
  kernels/texture_stages.hpp kernels/tile_stages.hpp)
target_include_directories(test_contract_headers PRIVATE ${PROJECT_SOURCE_DIR})
burnish_test_symbols(test_contract_headers)

# Rules about the sources, and the installed package.
add_test(NAME includes COMMAND ${CMAKE_COMMAND} -P ${CMAKE_CURRENT_SOURCE_DIR}/check_includes.cmake)
add_test(NAME elementary_functions
  COMMAND ${CMAKE_COMMAND} -P ${CMAKE_CURRENT_SOURCE_DIR}/check_elementary_functions.cmake)
set(sanitize "")
if(BURNISH_SANITIZE)
  set(sanitize -fsanitize=${BURNISH_SANITIZE})
endif()
add_test(NAME package
  COMMAND ${CMAKE_COMMAND} -DBUILD=${PROJECT_BINARY_DIR} -DSOURCE=${PROJECT_SOURCE_DIR}
    -DCOMPILER=${CMAKE_CXX_COMPILER} -DGENERATOR=${CMAKE_GENERATOR} -DBINDIR=${CMAKE_INSTALL_BINDIR}
    -DFLAGS=${sanitize}
    -P ${CMAKE_CURRENT_SOURCE_DIR}/check_package.cmake)
set_tests_properties(package PROPERTIES TIMEOUT 300)

# The quick form of every experiment; with sanitizers tests/experiment.cpp has to do.
if(NOT BURNISH_SANITIZE)
  foreach(name e1 e2 e3 e4 e5 e6 e7 e7_edge e8 e9 e10 e11 e12)
    add_test(NAME experiment.${name} COMMAND burnish_command experiment ${name} --quick
      -o ${CMAKE_CURRENT_BINARY_DIR}/experiments/${name})
    set_tests_properties(experiment.${name} PROPERTIES TIMEOUT 300)
  endforeach()
endif()
