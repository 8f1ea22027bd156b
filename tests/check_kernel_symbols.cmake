# cmake -DNM=<nm> -DOBJECTS=<a.o;b.o> -DALLOWED=<function>... -P check_kernel_symbols.cmake
#
# An object compiled for one instruction set must offer no function but its table: any other (a
# template, an inline function of a header) could be the copy that the linker keeps for the whole
# program, and an old CPU would then stop on it. ALLOWED is a list of names burnish::<name>() or
# empty.
set(accepted "")
foreach(name IN LISTS ALLOWED)
  list(APPEND accepted "burnish::${name}()")
endforeach()

set(foreign "")
foreach(object IN LISTS OBJECTS)
  execute_process(COMMAND ${NM} -C --defined-only --extern-only ${object}
                  OUTPUT_VARIABLE lines COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX REPLACE "\n+" ";" lines "${lines}")
  foreach(line IN LISTS lines)
    # value, type, demangled name
    if(line MATCHES "^[0-9a-f]+ [A-Za-z] (.+)$" AND NOT CMAKE_MATCH_1 IN_LIST accepted)
      string(APPEND foreign "  ${CMAKE_MATCH_1}\n")
    endif()
  endforeach()
endforeach()
if(foreign)
  message(FATAL_ERROR "visible outside their object, expected only [${ALLOWED}]:\n${foreign}")
endif()
