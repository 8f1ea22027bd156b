# What `cmake --install` leaves: the command with its manual page and completions, the libraries,
# the public headers, and a package with which find_package(burnish CONFIG) gives burnish::burnish.

# The tree may be moved as a whole: each binary finds its libraries relative to itself.
# libburnish opens libburnish_io by name, so the path counts for that, too.
file(RELATIVE_PATH libraries_from_command /${CMAKE_INSTALL_BINDIR} /${CMAKE_INSTALL_LIBDIR})
set_target_properties(burnish_command PROPERTIES INSTALL_RPATH "$ORIGIN/${libraries_from_command}")
set_target_properties(burnish burnish_io PROPERTIES INSTALL_RPATH "$ORIGIN")

if(BURNISH_VIEW)
  set_target_properties(burnish_view PROPERTIES INSTALL_RPATH "$ORIGIN")
  install(TARGETS burnish_view LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} NAMELINK_SKIP)
endif()

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/burnish)
install(TARGETS burnish EXPORT burnishTargets
  RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR}
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS burnish_io burnish_command
  RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR}
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} NAMELINK_SKIP)
install(DIRECTORY src/include/burnish DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  FILES_MATCHING PATTERN "*.hpp")
install(FILES ${PROJECT_BINARY_DIR}/share/burnish.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${PROJECT_BINARY_DIR}/share/burnish.bash RENAME burnish
  DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/bash-completion/completions)
install(FILES ${PROJECT_BINARY_DIR}/share/_burnish
  DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/zsh/site-functions)
install(FILES LICENSE README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})

install(EXPORT burnishTargets NAMESPACE burnish:: DESTINATION ${package_dir})
configure_package_config_file(cmake/burnishConfig.cmake.in
  ${PROJECT_BINARY_DIR}/burnishConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/burnishConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/burnishConfig.cmake
              ${PROJECT_BINARY_DIR}/burnishConfigVersion.cmake
  DESTINATION ${package_dir})
