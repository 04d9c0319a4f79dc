# A value that its Kconfig symbol cannot have ends the configuration in one line. Before find_package(Zephyr), which would print
# warnings over many lines, and "command failed".
#   agv_check_settings(FOLDER)             FOLDER: that of prj.conf
function(agv_check_settings folder)
  set(files ${CONF_FILE})
  if(NOT files)
    string(REGEX REPLACE "[/@]" "_" board "${BOARD}")
    set(files prj.conf boards/${board}.conf)
  endif()
  string(REPLACE " " ";" files "${files};${OVERLAY_CONFIG};${EXTRA_CONF_FILE}")
  set(sources "")
  foreach(file IN LISTS files)
    cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY ${folder} NORMALIZE)
    if(EXISTS ${file} AND NOT IS_DIRECTORY ${file}) # Zephyr names one that is missing
      list(APPEND sources ${file})
    endif()
  endforeach()
  get_cmake_property(variables CACHE_VARIABLES)
  foreach(name IN LISTS variables)
    if(name MATCHES "^CONFIG_AGV_" AND DEFINED ${name})
      list(APPEND sources "${name}=${${name}}")
    endif()
  endforeach()

  if(NOT sources)
    return()
  endif()
  find_program(AGV_PYTHON NAMES ${Python3_EXECUTABLE} python3 python REQUIRED)
  mark_as_advanced(AGV_PYTHON)
  execute_process(COMMAND ${AGV_PYTHON} ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/../../scripts/tools/zephyr-board.py settings ${sources}
    RESULT_VARIABLE status ERROR_VARIABLE refused)
  if(status)
    string(STRIP "${refused}" refused)
    message(FATAL_ERROR " ${refused}") # CMake wraps a line that does not begin with a space
  endif()
endfunction()
