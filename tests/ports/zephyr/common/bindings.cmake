# Before find_package(Zephyr): where the bindings are, AGV_ROOT being known. A copy of the sources in a workspace of west is given
# those of the original (AGV_DTS_ROOT): west's module has them, and two of the same name are an error.
if(NOT DEFINED AGV_DTS_ROOT)
  set(AGV_DTS_ROOT ${AGV_ROOT}/hal/zephyr)
endif()
list(APPEND DTS_ROOT ${AGV_DTS_ROOT})
include(${AGV_ROOT}/hal/zephyr/checksum.cmake)
