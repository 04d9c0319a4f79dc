# What the tests of the Zephyr application share. Before find_package(Zephyr): the folders; after project(): add_agv_test().
get_filename_component(AGV_ROOT ${CMAKE_CURRENT_LIST_DIR}/../../.. ABSOLUTE)
set(AGV_TEST_COMMON ${CMAKE_CURRENT_LIST_DIR})
# A copy of the sources in a workspace of west takes the bindings of the original: west's module has those, and twice is an error.
if(NOT DEFINED AGV_DTS_ROOT)
  set(AGV_DTS_ROOT ${AGV_ROOT}/hal/zephyr)
endif()
list(APPEND DTS_ROOT ${AGV_DTS_ROOT} ${AGV_TEST_COMMON})
set(KCONFIG_ROOT ${AGV_TEST_COMMON}/Kconfig)
list(APPEND CONF_FILE ${AGV_TEST_COMMON}/common.conf prj.conf)
list(APPEND DTC_OVERLAY_FILE ${AGV_TEST_COMMON}/common.overlay)
if(EXISTS ${AGV_TEST_COMMON}/boards/${BOARD}.overlay)
  list(APPEND DTC_OVERLAY_FILE ${AGV_TEST_COMMON}/boards/${BOARD}.overlay)
endif()

if(EXISTS ${AGV_TEST_COMMON}/boards/${BOARD}.conf)
  list(APPEND CONF_FILE ${AGV_TEST_COMMON}/boards/${BOARD}.conf)
endif()
if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/app.overlay)
  list(APPEND DTC_OVERLAY_FILE ${CMAKE_CURRENT_SOURCE_DIR}/app.overlay)
endif()

macro(add_agv_test)
  include(${AGV_ROOT}/firmware/zephyr/sources.cmake)
  target_sources(app PRIVATE ${AGV_CORE_SOURCES} ${AGV_ZEPHYR_PORT_SOURCES} ${AGV_APP_SOURCES} ${ARGN})
  target_include_directories(app PRIVATE ${AGV_CORE_INCLUDES} ${AGV_ZEPHYR_PORT_INCLUDES} ${AGV_APP_DIR}/src
    ${AGV_ZEPHYR_PORT_DIR}/src ${AGV_TEST_COMMON} ${APPLICATION_BINARY_DIR}/agv)
  file(WRITE ${APPLICATION_BINARY_DIR}/agv/app_version.h "#define APP_VERSION_STRING \"test\"\n")
endmacro()
