# The sources of the application but for main.c, for it and for its tests.
include(${CMAKE_CURRENT_LIST_DIR}/../sources.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/../../hal/zephyr/sources.cmake)
set(AGV_APP_DIR ${CMAKE_CURRENT_LIST_DIR})
set(AGV_APP_SOURCES
  ${AGV_APP_DIR}/src/checks.c
  ${AGV_APP_DIR}/src/event_text.c
  ${AGV_APP_DIR}/src/events.c
  ${AGV_APP_DIR}/src/kconfig.c
  ${AGV_APP_DIR}/src/supervise.c
)
# Where Zephyr compiles freestanding, copying a word would be a call of memcpy(), and a tick would take four times as long.
set_source_files_properties(${AGV_CORE_SOURCES} ${AGV_ZEPHYR_PORT_SOURCES} ${AGV_APP_SOURCES}
  TARGET_DIRECTORY app PROPERTIES COMPILE_OPTIONS -fbuiltin)

# Version and board, which events.c prints.
include(${AGV_APP_DIR}/board.cmake)
agv_add_build_info(app)

# The commands of the shell.
zephyr_linker_sources(SECTIONS ${AGV_APP_DIR}/shell-commands.ld)
