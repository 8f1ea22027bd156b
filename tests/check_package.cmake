# Installs the build into an empty prefix, moves the prefix, builds tests/consumer out of tree
# against it and compares the consumer's picture with the installed command's.
# cmake -DBUILD=<build tree> -DSOURCE=<source tree> -DCOMPILER=<c++> -DFLAGS=<c++ flags>
#       -DGENERATOR=<generator> -DBINDIR=<bin> -P check_package.cmake
cmake_minimum_required(VERSION 3.25)
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

set(work ${BUILD}/package)
set(prefix ${work}/moved)
file(REMOVE_RECURSE ${work})
file(MAKE_DIRECTORY ${work})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${work}/installed)
file(RENAME ${work}/installed ${prefix})
foreach(file man/man1/burnish.1 bash-completion/completions/burnish zsh/site-functions/_burnish)
  file(SIZE ${prefix}/share/${file} size)
  if(size LESS 1000)
    message(FATAL_ERROR "share/${file}: ${size} bytes")
  endif()
endforeach()

run(${CMAKE_COMMAND} -S ${SOURCE}/tests/consumer -B ${work}/consumer -G ${GENERATOR}
    -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_FLAGS=${FLAGS}
    -DCMAKE_BUILD_TYPE=Release)
run(${CMAKE_COMMAND} --build ${work}/consumer)
run(${prefix}/${BINDIR}/burnish render ${SOURCE}/tests/consumer/scene.toml -o ${work}/command.png)
run(${work}/consumer/consumer ${SOURCE}/tests/consumer/octahedron.obj ${work}/command.png)

# The README's program and its build file, as they stand there.
file(READ ${SOURCE}/README.md readme)
string(REGEX MATCH "```cpp\n([^`]*)```" ignored "${readme}")
set(program "${CMAKE_MATCH_1}")
string(REGEX MATCH "^(#include[^\n]*\n)+" includes "${program}")
string(REPLACE "${includes}" "" body "${program}")
string(REGEX MATCH "```cmake\n([^`]*)```" ignored "${readme}")
file(WRITE ${work}/readme/CMakeLists.txt
  "cmake_minimum_required(VERSION 3.25)\nproject(readme CXX)\nadd_executable(program main.cpp)\n"
  "${CMAKE_MATCH_1}")
file(WRITE ${work}/readme/main.cpp "${includes}int main() {\n${body}}\n")
file(COPY ${SOURCE}/meshes DESTINATION ${work}/readme)
run(${CMAKE_COMMAND} -S ${work}/readme -B ${work}/readme/build -G ${GENERATOR}
    -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_FLAGS=${FLAGS}
    -DCMAKE_BUILD_TYPE=Release)
run(${CMAKE_COMMAND} --build ${work}/readme/build)
run(${CMAKE_COMMAND} -E chdir ${work}/readme ${work}/readme/build/program)
if(NOT EXISTS ${work}/readme/knot.png)
  message(FATAL_ERROR "the README's program wrote no picture")
endif()
