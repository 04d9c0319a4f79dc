# The portable core for Cortex-M: one static library a processor, and a linked image whose sections scripts/tools/size.py counts.

set(AGV_CPUS cortex-m0plus cortex-m4 cortex-m7)

# Options that make the core smaller than -Os alone (gcc 12). A firmware may use them, too.
set(AGV_SMALL_OPTIONS
  -fno-thread-jumps                 # no second copy of code for a path on which a later condition is already known
  -fno-tree-dominator-opts          # the same, found by another pass
  -freorder-blocks-algorithm=stc    # blocks that follow each other stand side by side: fewer jumps
  -fno-schedule-insns2              # no reordering for speed, which takes the short encodings of instructions away
  -fno-caller-saves                 # values that outlive a call lie in registers that the call keeps, not on the stack
  -fno-if-conversion                # a short jump rather than arithmetic with conditions
  -fno-tree-tail-merge              # it joins equal ends of branches into one with moves of registers in front of it
  -fno-move-loop-invariants         # what a short loop needs is made in the loop, not kept in a register around it
  -fno-tree-loop-im                 # the same, in an earlier pass
  -fno-optimize-sibling-calls       # a last call as a jump takes all registers back first, at every such place
  -fno-ipa-vrp                      # no copies of code for ranges of values
  -fno-forward-propagate            # what was computed once is not computed again where it is used
  --param=uninlined-function-insns=0 # a call costs less than gcc thinks: inline less
)

if(AGV_TARGET_TESTS)
  include(AgvTargetTests)
  return()
endif()

# The target `target` compiled once more, for one processor, from the same sources: `<target>_<cpu>`.
function(agv_build_for_cpu target cpu)
  get_target_property(sources ${target} SOURCES)
  get_target_property(folder ${target} SOURCE_DIR)
  get_target_property(includes ${target} INCLUDE_DIRECTORIES)
  set(paths)
  foreach(source IN LISTS sources)
    get_filename_component(path ${source} ABSOLUTE BASE_DIR ${folder})
    list(APPEND paths ${path})
  endforeach()
  set(library ${target}_${cpu})
  add_library(${library} STATIC ${paths})
  target_include_directories(${library} PUBLIC "${includes}") # quoted: it has generator expressions with lists
  target_compile_options(${library} PRIVATE
    -mcpu=${cpu} -mthumb -ffunction-sections -fdata-sections -fstack-usage -fcallgraph-info=su
    ${AGV_SMALL_OPTIONS})
  target_link_libraries(${library} PRIVATE agv_options)
endfunction()

add_subdirectory(firmware EXCLUDE_FROM_ALL)
add_subdirectory(hal/template EXCLUDE_FROM_ALL)
add_subdirectory(tests/seeded)
add_subdirectory(tests/proofs/target)
foreach(cpu IN LISTS AGV_CPUS)
  agv_build_for_cpu(agv_core ${cpu})
  agv_build_for_cpu(hal_template ${cpu})
endforeach()

# Every function that a firmware image calls; the linker keeps only these and the functions that they call.
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

add_subdirectory(tests/proofs/image)

add_test(NAME size_budget COMMAND ${PROJECT_SOURCE_DIR}/scripts/tools/size.py --build ${PROJECT_BINARY_DIR})
