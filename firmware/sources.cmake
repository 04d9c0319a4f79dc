# The sources of the portable core, for every build system that compiles it (this one and Zephyr's).
set(AGV_CORE_DIR ${CMAKE_CURRENT_LIST_DIR})
set(AGV_CORE_SOURCES
  ${AGV_CORE_DIR}/src/checksum.c
  ${AGV_CORE_DIR}/src/codec.c
  ${AGV_CORE_DIR}/src/config.c
  ${AGV_CORE_DIR}/src/faults.c
  ${AGV_CORE_DIR}/src/liveness.c
  ${AGV_CORE_DIR}/src/message.c
  ${AGV_CORE_DIR}/src/monitor_frames.c
  ${AGV_CORE_DIR}/src/monitor_timed.c
  ${AGV_CORE_DIR}/src/names.c
  ${AGV_CORE_DIR}/src/recorder.c
  ${AGV_CORE_DIR}/src/state.c
)
set(AGV_CORE_INCLUDES
  ${AGV_CORE_DIR}/include
  ${AGV_CORE_DIR}/../hal/include
)
