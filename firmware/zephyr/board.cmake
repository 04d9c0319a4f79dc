# What devicetree and configuration say of the board: mistakes end the configuration in one line each; facts and revision
# become headers. After find_package(Zephyr).
set(AGV_BOARD_SCRIPT ${CMAKE_CURRENT_LIST_DIR}/../../scripts/tools/zephyr-board.py)
set(AGV_REVISION_SCRIPT ${CMAKE_CURRENT_LIST_DIR}/revision.cmake)
set(AGV_GENERATED_DIR ${APPLICATION_BINARY_DIR}/agv/generated)

function(agv_board what result)
  execute_process(COMMAND ${PYTHON_EXECUTABLE} ${AGV_BOARD_SCRIPT} ${what} --zephyr-base ${ZEPHYR_BASE} ${APPLICATION_BINARY_DIR}
    RESULT_VARIABLE status OUTPUT_VARIABLE printed ERROR_VARIABLE refused)
  if(status)
    string(STRIP "${refused}" refused)
    message(FATAL_ERROR " ${refused}") # CMake wraps a line that does not begin with a space
  endif()
  set(${result} "${printed}" PARENT_SCOPE)
endfunction()

# agv_check_board(): refuse what cannot work, or may not be released.
function(agv_check_board)
  agv_board(check ignored)
endfunction()

# agv_add_build_info(TARGET): its sources find agv_board.h (facts) and agv_revision.h (of the sources, as they are when it builds).
function(agv_add_build_info target)
  zephyr_get(AGV_REVISION) # sysbuild does not pass it on to the application by itself
  agv_board(header facts)
  file(MAKE_DIRECTORY ${AGV_GENERATED_DIR})
  file(CONFIGURE OUTPUT ${AGV_GENERATED_DIR}/agv_board.h CONTENT "${facts}" @ONLY)
  add_custom_target(agv_revision
    COMMAND ${CMAKE_COMMAND} -DAGV_REVISION=${AGV_REVISION} -DAGV_REVISION_HEADER=${AGV_GENERATED_DIR}/agv_revision.h -P ${AGV_REVISION_SCRIPT}
    BYPRODUCTS ${AGV_GENERATED_DIR}/agv_revision.h
    COMMENT "Revision of the sources")
  add_dependencies(${target} agv_revision)
  target_include_directories(${target} PRIVATE ${AGV_GENERATED_DIR})
endfunction()
