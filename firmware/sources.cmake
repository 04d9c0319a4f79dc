# The sources of the portable core, for every build system that compiles it (this one and Zephyr's).
set(AGV_CORE_DIR ${CMAKE_CURRENT_LIST_DIR})
set(AGV_CORE_SOURCES
  ${AGV_CORE_DIR}/src/base/checksum.c
  ${AGV_CORE_DIR}/src/base/codec.c
  ${AGV_CORE_DIR}/src/base/config.c
  ${AGV_CORE_DIR}/src/base/fault_monitor.c
  ${AGV_CORE_DIR}/src/base/fault_table.c
  ${AGV_CORE_DIR}/src/base/message.c
  ${AGV_CORE_DIR}/src/base/names.c
  ${AGV_CORE_DIR}/src/base/score.c
  ${AGV_CORE_DIR}/src/base/state.c
  ${AGV_CORE_DIR}/src/base/timers.c
  ${AGV_CORE_DIR}/src/decide/confirmation.c
  ${AGV_CORE_DIR}/src/decide/hold.c
  ${AGV_CORE_DIR}/src/decide/reset_button.c
  ${AGV_CORE_DIR}/src/decide/state_machine.c
  ${AGV_CORE_DIR}/src/decide/stopping.c
  ${AGV_CORE_DIR}/src/keep/latch.c
  ${AGV_CORE_DIR}/src/keep/led.c
  ${AGV_CORE_DIR}/src/keep/recorder.c
  ${AGV_CORE_DIR}/src/observe/bus.c
  ${AGV_CORE_DIR}/src/observe/commands.c
  ${AGV_CORE_DIR}/src/observe/deadlines.c
  ${AGV_CORE_DIR}/src/observe/hardware.c
  ${AGV_CORE_DIR}/src/observe/intrusion.c
  ${AGV_CORE_DIR}/src/observe/liveness.c
  ${AGV_CORE_DIR}/src/observe/mode.c
  ${AGV_CORE_DIR}/src/observe/motion_checks.c
  ${AGV_CORE_DIR}/src/observe/status_checks.c
  ${AGV_CORE_DIR}/src/observe/vehicle.c
  ${AGV_CORE_DIR}/src/supervisor/supervisor.c
  ${AGV_CORE_DIR}/src/supervisor/supervisor_frame.c
  ${AGV_CORE_DIR}/src/supervisor/supervisor_pass.c
  ${AGV_CORE_DIR}/src/supervisor/supervisor_read.c
  ${AGV_CORE_DIR}/src/supervisor/supervisor_start.c
  ${AGV_CORE_DIR}/src/supervisor/supervisor_tick.c
  ${AGV_CORE_DIR}/src/transmit/gate.c
  ${AGV_CORE_DIR}/src/transmit/gateway.c
  ${AGV_CORE_DIR}/src/transmit/scheduler.c
  ${AGV_CORE_DIR}/src/transmit/transmitter.c
)
set(AGV_CORE_INCLUDES
  ${AGV_CORE_DIR}/include
  ${AGV_CORE_DIR}/../hal/include
)
# What the sources of the core share among themselves, and with their tests; programs do not know it.
set(AGV_CORE_PRIVATE_INCLUDES ${AGV_CORE_DIR}/src)
