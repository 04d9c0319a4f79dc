# `cmake --install`: host_sim with its scenarios, pages, man pages and completion (component host), and the core for other
# programs with their own port (component dev): headers, library, CMake package. `cpack` makes a Debian package of each.
set(CMAKE_INSTALL_DOCDIR share/doc/agv-supervisor)
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS host_sim RUNTIME COMPONENT host)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/host_sim/scenarios ${PROJECT_SOURCE_DIR}/host_sim/examples ${PROJECT_SOURCE_DIR}/protocol
  DESTINATION ${CMAKE_INSTALL_DATADIR}/agv-supervisor COMPONENT host PATTERN CMakeLists.txt EXCLUDE)
install(DIRECTORY ${PROJECT_BINARY_DIR}/schemas DESTINATION ${CMAKE_INSTALL_DATADIR}/agv-supervisor COMPONENT host)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT host) # links between the pages hold
install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md ${PROJECT_SOURCE_DIR}/SECURITY.md ${PROJECT_SOURCE_DIR}/LICENSE
  DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT host)

# Man pages and completion; Debian has its own folder for the completion of packages in zsh.
set(AGV_ZSH_COMPLETION zsh/site-functions CACHE STRING "Folder below share for the completion in zsh")
if(NOT CMAKE_CROSSCOMPILING)
  set(shell_files ${PROJECT_BINARY_DIR}/shell-files)
  add_custom_command(
    OUTPUT ${shell_files}/man/man1
    COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:host_sim> -DTO=${shell_files} -DZSH=${AGV_ZSH_COMPLETION}
      -P ${CMAKE_CURRENT_LIST_DIR}/write-shell-files.cmake
    DEPENDS host_sim ${CMAKE_CURRENT_LIST_DIR}/write-shell-files.cmake
    COMMENT "Writing man pages and completion"
    VERBATIM
  )
  add_custom_target(host_sim_shell_files ALL DEPENDS ${shell_files}/man/man1)
  install(DIRECTORY ${shell_files}/ DESTINATION ${CMAKE_INSTALL_DATADIR} COMPONENT host)
endif()

set(package ${CMAKE_INSTALL_LIBDIR}/cmake/AgvSupervisor)
install(TARGETS agv_core EXPORT AgvSupervisor ARCHIVE COMPONENT dev)
if(CMAKE_STRIP) # only code: what gcc keeps for optimising at link time is of no use to another compiler
  install(CODE "execute_process(COMMAND ${CMAKE_STRIP} --strip-debug --remove-section=.comment --remove-section=.gnu.lto_*
    \$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR}/libagv_core.a COMMAND_ERROR_IS_FATAL ANY)" COMPONENT dev)
endif()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/firmware/include/agv ${PROJECT_SOURCE_DIR}/hal/include/hal
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/agv-supervisor COMPONENT dev)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/hal/template DESTINATION ${CMAKE_INSTALL_DATADIR}/agv-supervisor/hal COMPONENT dev
  PATTERN CMakeLists.txt EXCLUDE)
install(EXPORT AgvSupervisor NAMESPACE AgvSupervisor:: FILE AgvSupervisorConfig.cmake DESTINATION ${package} COMPONENT dev)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/AgvSupervisorConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/AgvSupervisorConfigVersion.cmake DESTINATION ${package} COMPONENT dev)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME agv-supervisor)
set(CPACK_PACKAGE_CONTACT "The maintainers of the AGV safety supervisor <maintainers@agv-supervisor.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL host dev)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_HOST_PACKAGE_NAME agv-supervisor)
set(CPACK_DEBIAN_DEV_PACKAGE_NAME agv-supervisor-dev)
set(CPACK_DEBIAN_HOST_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_HOST_PACKAGE_SECTION utils)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_HOST_DESCRIPTION "host_sim: the supervisor as a program for Linux,\nwith a simulated vehicle and its scenarios")
set(CPACK_COMPONENT_DEV_DESCRIPTION "Portable core of the supervisor:\nheaders, static library, CMake package")
include(CPack)

# What Debian's policy wants in each package.
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
configure_file(${CMAKE_CURRENT_LIST_DIR}/debian/changelog.in ${PROJECT_BINARY_DIR}/debian/changelog @ONLY)
file(ARCHIVE_CREATE OUTPUT ${PROJECT_BINARY_DIR}/debian/changelog.gz PATHS ${PROJECT_BINARY_DIR}/debian/changelog
  FORMAT raw COMPRESSION GZip COMPRESSION_LEVEL 9 MTIME 0)
foreach(component host dev)
  string(TOUPPER ${component} upper)
  set(folder share/doc/${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
  install(FILES ${PROJECT_BINARY_DIR}/debian/changelog.gz DESTINATION ${folder} COMPONENT ${component})
  install(FILES ${CMAKE_CURRENT_LIST_DIR}/debian/copyright DESTINATION ${folder} COMPONENT ${component})
endforeach()
