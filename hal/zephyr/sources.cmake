# The sources of the Zephyr port, for the application and for its tests.
set(AGV_ZEPHYR_PORT_DIR ${CMAKE_CURRENT_LIST_DIR})
set(AGV_ZEPHYR_PORT_SOURCES
  ${AGV_ZEPHYR_PORT_DIR}/src/zephyr_can.c
  ${AGV_ZEPHYR_PORT_DIR}/src/zephyr_end.c
  ${AGV_ZEPHYR_PORT_DIR}/src/zephyr_hal.c
  ${AGV_ZEPHYR_PORT_DIR}/src/zephyr_log.c
  ${AGV_ZEPHYR_PORT_DIR}/src/zephyr_pins.c
  ${AGV_ZEPHYR_PORT_DIR}/src/zephyr_queue.c
  ${AGV_ZEPHYR_PORT_DIR}/src/zephyr_retained.c
  ${AGV_ZEPHYR_PORT_DIR}/src/zephyr_second_clock.c
  ${AGV_ZEPHYR_PORT_DIR}/src/zephyr_self_test.c
  ${AGV_ZEPHYR_PORT_DIR}/src/zephyr_watchdog.c
  ${AGV_ZEPHYR_PORT_DIR}/src/$<IF:$<BOOL:${CONFIG_SOC_FAMILY_STM32}>,zephyr_stm32.c,zephyr_no_chip.c>
)
set(AGV_ZEPHYR_PORT_INCLUDES ${AGV_ZEPHYR_PORT_DIR}/include)

zephyr_compile_definitions(AGV_RECORDER_EVENTS=${CONFIG_AGV_RECORDER_EVENTS}u)

# Checks that only the linker can make.
zephyr_linker_sources(SECTIONS ${AGV_ZEPHYR_PORT_DIR}/linker/log-partition.ld)

agv_write_checksum_step()
