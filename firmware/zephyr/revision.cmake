# The revision of the sources, as a header: cmake -DAGV_REVISION_HEADER=FILE [-DAGV_REVISION=TEXT] -P revision.cmake
# Sources without a git repository: give AGV_REVISION, otherwise it is "unknown".
get_filename_component(root ${CMAKE_CURRENT_LIST_DIR}/../.. ABSOLUTE)
if(NOT AGV_REVISION)
  execute_process(COMMAND git describe --always --dirty=.dirty --abbrev=12 --exclude=* WORKING_DIRECTORY ${root}
    RESULT_VARIABLE status OUTPUT_VARIABLE AGV_REVISION ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(NOT "${status}" STREQUAL "0")
    set(AGV_REVISION unknown)
  endif()
endif()
if(NOT AGV_REVISION MATCHES "^[0-9A-Za-z.-]+$")
  message(FATAL_ERROR " AGV_REVISION=${AGV_REVISION}: a revision has letters, digits, '.' and '-' only")
endif()
file(CONFIGURE OUTPUT ${AGV_REVISION_HEADER} CONTENT "#define AGV_REVISION \"@AGV_REVISION@\"\n" @ONLY) # rewritten only when it differs
