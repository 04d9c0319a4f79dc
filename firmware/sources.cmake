# The sources of the portable core, for every build system that compiles it (this one and Zephyr's).
set(AGV_CORE_DIR ${CMAKE_CURRENT_LIST_DIR})
set(AGV_CORE_SOURCES
  ${AGV_CORE_DIR}/src/codec.c
  ${AGV_CORE_DIR}/src/message.c
)
set(AGV_CORE_INCLUDES
  ${AGV_CORE_DIR}/include
  ${AGV_CORE_DIR}/../hal/include
)
