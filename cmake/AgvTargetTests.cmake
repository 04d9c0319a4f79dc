# The unit and integration tests for a Cortex-M4, run by QEMU as a machine without an operating system (preset target):
# the same programs from the same lists as on the host, and the core compiled as scripts/tools/size.py measures it.
# newlib's crt0 takes memory, output and the end of a program from QEMU (semihosting).

add_compile_options(-mcpu=cortex-m4 -mthumb -ffunction-sections -fdata-sections)
add_compile_definitions(UNITY_SUPPORT_64) # Unity finds out from the size of a pointer, and leaves it out here
add_link_options(-mcpu=cortex-m4 -mthumb --specs=rdimon.specs -Wl,--gc-sections -Wl,--section-start=.vectors=0
  -Wl,--require-defined=agv_target_vectors)
set(CMAKE_CROSSCOMPILING_EMULATOR ${PROJECT_SOURCE_DIR}/tests/proofs/target/emulate)

add_library(agv_target_start OBJECT ${PROJECT_SOURCE_DIR}/tests/proofs/target/start.c)
target_link_libraries(agv_target_start PRIVATE agv_options)
set(AGV_TEST_START $<TARGET_OBJECTS:agv_target_start>)

add_subdirectory(firmware)
target_compile_options(agv_core PRIVATE ${AGV_SMALL_OPTIONS})
add_subdirectory(hal/forward)
add_subdirectory(hal/sim)
add_subdirectory(hal/template)
add_subdirectory(tests)
