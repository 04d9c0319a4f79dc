# The portable core for Cortex-M: one static library a processor, and one linked image whose sections scripts/size counts.

set(AGV_CPUS cortex-m0plus cortex-m4 cortex-m7)

# The target `target` compiled once more, for one processor: `<target>_<cpu>`, from the same sources.
function(agv_build_for_cpu target cpu)
  get_target_property(sources ${target} SOURCES)
  get_target_property(folder ${target} SOURCE_DIR)
  get_target_property(includes ${target} INCLUDE_DIRECTORIES)
  set(paths)
  foreach(source IN LISTS sources)
    get_filename_component(path ${source} ABSOLUTE BASE_DIR ${folder})
    list(APPEND paths ${path})
  endforeach()
  add_library(${target}_${cpu} STATIC ${paths})
  target_include_directories(${target}_${cpu} PUBLIC ${includes})
  target_compile_options(${target}_${cpu} PRIVATE
    -mcpu=${cpu} -mthumb -ffunction-sections -fdata-sections -fstack-usage -fcallgraph-info=su)
  target_link_libraries(${target}_${cpu} PRIVATE agv_options)
endfunction()

add_subdirectory(firmware EXCLUDE_FROM_ALL)
add_subdirectory(hal/template EXCLUDE_FROM_ALL)
add_subdirectory(tests/planted)
foreach(cpu IN LISTS AGV_CPUS)
  agv_build_for_cpu(agv_core ${cpu})
  agv_build_for_cpu(hal_template ${cpu})
endforeach()

# Every function that a firmware image has to call; the linker keeps these and what they reach, and nothing else.
set(AGV_ENTRY_POINTS
  agv_config_defaults
  agv_supervisor_start
  agv_supervisor_frame
  agv_supervisor_tick
  agv_supervisor_receive_alive
)
add_executable(size_image ${PROJECT_SOURCE_DIR}/tests/size/size_image.c)
target_compile_options(size_image PRIVATE -mcpu=cortex-m4 -mthumb)
target_link_libraries(size_image PRIVATE agv_options agv_core_cortex-m4 hal_template_cortex-m4)
target_link_options(size_image PRIVATE
  -mcpu=cortex-m4 -mthumb -nostartfiles -Wl,--entry=main -Wl,--gc-sections -Wl,-Map=${PROJECT_BINARY_DIR}/size_image.map)
foreach(entry IN LISTS AGV_ENTRY_POINTS)
  target_link_options(size_image PRIVATE -Wl,--require-defined=${entry})
endforeach()

add_test(NAME size_budget COMMAND ${PROJECT_SOURCE_DIR}/scripts/size --build ${PROJECT_BINARY_DIR})
