# Revision of the sources and version, as a header: cmake -DAGV_REVISION_HEADER=FILE [-DAGV_REVISION=TEXT] -P revision.cmake
# Sources without a git repository: give AGV_REVISION, otherwise it is "unknown".
cmake_minimum_required(VERSION 3.20)
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
# For the status frame: the first 8 hexadecimal digits, 0 when the revision is none of git's.
if(AGV_REVISION MATCHES "^([0-9a-f][0-9a-f][0-9a-f][0-9a-f][0-9a-f][0-9a-f][0-9a-f][0-9a-f])")
  set(number 0x${CMAKE_MATCH_1}u)
else()
  set(number 0u)
endif()
file(READ ${CMAKE_CURRENT_LIST_DIR}/VERSION version)
string(REGEX MATCH "VERSION_MAJOR = ([0-9]+).*VERSION_MINOR = ([0-9]+).*PATCHLEVEL = ([0-9]+)" version "${version}")
file(CONFIGURE OUTPUT ${AGV_REVISION_HEADER} @ONLY CONTENT "#define AGV_REVISION \"${AGV_REVISION}\"
#define AGV_REVISION_NUMBER ${number}
#define AGV_VERSION_MAJOR ${CMAKE_MATCH_1}u
#define AGV_VERSION_MINOR ${CMAKE_MATCH_2}u
#define AGV_VERSION_PATCH ${CMAKE_MATCH_3}u
") # rewritten only when it differs
