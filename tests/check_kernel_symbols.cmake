# cmake -DNM=<nm> -DOBJECTS=<a.o;b.o> [-DISA=<name>] -P check_kernel_symbols.cmake
#
# An object compiled for one instruction set must offer nothing but its table and what lies in the
# namespace that xsimd has in this object alone: any other function (a template, an inline function
# of a header) could be the copy that the linker keeps for the whole program, and an old CPU would
# then stop on it. Type information, which sanitizers ask for, is data. Without ISA nothing at all may
# be visible.
cmake_minimum_required(VERSION 3.25)
set(accepted "^$")
if(ISA)
  set(accepted "^(burnish::table_${ISA}\\(\\)$|xsimd_${ISA}::|typeinfo (name )?for )")
endif()

set(foreign "")
foreach(object IN LISTS OBJECTS)
  execute_process(COMMAND ${NM} -C --defined-only --extern-only ${object}
                  OUTPUT_VARIABLE lines COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX REPLACE "\n+" ";" lines "${lines}")
  foreach(line IN LISTS lines)
    if(line MATCHES "^[0-9a-f]+ [A-Za-z] (.+)$")  # value, type, name
      set(name "${CMAKE_MATCH_1}")
      if(NOT name MATCHES "${accepted}")
        string(APPEND foreign "  ${name}\n")
      endif()
    endif()
  endforeach()
endforeach()
if(foreign)
  message(FATAL_ERROR "visible outside their object, expected names like ${accepted}:\n${foreign}")
endif()
