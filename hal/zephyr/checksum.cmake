# The checksum of the program, written into it after linking, before an image is signed (HW-4). Zephyr takes the steps after
# linking from a property that must be set before find_package(Zephyr) has ended; the tools are known only after it:
#   include(.../checksum.cmake)            before find_package(Zephyr)
#   agv_write_checksum_step()              after it
set(AGV_CHECKSUM_SCRIPT ${CMAKE_CURRENT_LIST_DIR}/../../scripts/tools/zephyr-checksum.py)
set(AGV_CHECKSUM_STEP ${CMAKE_BINARY_DIR}/agv/checksum-step.cmake)
set_property(GLOBAL APPEND PROPERTY extra_post_build_commands COMMAND ${CMAKE_COMMAND} -P ${AGV_CHECKSUM_STEP})

function(agv_write_checksum_step)
  if(CONFIG_AGV_FLASH_TEST)
    file(CONFIGURE OUTPUT ${AGV_CHECKSUM_STEP} CONTENT "execute_process(
  COMMAND ${PYTHON_EXECUTABLE} ${AGV_CHECKSUM_SCRIPT} --objcopy ${CMAKE_OBJCOPY} ${APPLICATION_BINARY_DIR}/zephyr
  COMMAND_ERROR_IS_FATAL ANY)
" @ONLY)
  else()
    file(WRITE ${AGV_CHECKSUM_STEP} "# No checksum: the program does not run from flash.\n")
  endif()
endfunction()
