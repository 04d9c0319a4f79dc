# The host program optimised by a profile of itself (gcc): an hour on the simulated bus then takes more than a third less time.
#
#   agv_use_profile(target ...)
#
# The sources of the targets are compiled with a profile that an instrumented copy recorded on the simulated bus. The
# copy is made and run once, in profile/ of the build tree: sources that change afterwards keep the old counts, which
# cost speed and nothing else. A new build tree counts anew.
option(AGV_PROFILE "Optimise the host program by a profile of itself (gcc)" OFF)

set(AGV_PROFILE_DIR ${PROJECT_BINARY_DIR}/profile)
set(AGV_PROFILE_COUNTS ${AGV_PROFILE_DIR}/counts)
if(AGV_PROFILE AND CMAKE_C_COMPILER_ID STREQUAL "GNU" AND NOT AGV_INSTRUMENT)
  file(GLOB scenarios CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/host_sim/scenarios/*/*.yaml)
  add_custom_command(
    OUTPUT ${AGV_PROFILE_COUNTS}
    COMMAND ${CMAKE_COMMAND} -S ${PROJECT_SOURCE_DIR} -B ${AGV_PROFILE_DIR} -G ${CMAKE_GENERATOR} -Wno-dev
      -DCMAKE_BUILD_TYPE=None -DCMAKE_C_COMPILER=${CMAKE_C_COMPILER} -DCMAKE_C_FLAGS=${CMAKE_C_FLAGS}
      -DAGV_INSTRUMENT=profile
    COMMAND ${CMAKE_COMMAND} --build ${AGV_PROFILE_DIR} --target bench_sim host_sim
    COMMAND ${AGV_PROFILE_DIR}/bin/bench_sim 60
    COMMAND ${AGV_PROFILE_DIR}/bin/host_sim scenario ${scenarios}
    COMMAND ${AGV_PROFILE_DIR}/bin/host_sim campaign --runs 20 --seed 1
    COMMAND ${CMAKE_COMMAND} -DFROM=${AGV_PROFILE_DIR} -DFOR=${PROJECT_BINARY_DIR} -DTO=${AGV_PROFILE_COUNTS}
      -P ${CMAKE_CURRENT_LIST_DIR}/collect-profile.cmake
    COMMENT "Counting what the simulator does, to optimise it by"
    VERBATIM
  )
  add_custom_target(agv_profile DEPENDS ${AGV_PROFILE_COUNTS})
endif()

function(agv_use_profile)
  if(NOT TARGET agv_profile)
    return()
  endif()
  foreach(target IN LISTS ARGN)
    # -fprofile-partial-training: code that was not run, such as a reaction to a fault, is not optimised for size.
    # -fprofile-correction: a function that is new or changed since, and so has no counts, is no warning.
    # --param: what is counted as hot may grow together; short loops over tables of fixed size are unrolled whole, that
    # over the words under the seal (agv_seal) in four chains side by side. Invariants are not moved out of loops: the
    # addresses of all these words would be, to the stack. A sixth less time a tick.
    set(options -fprofile-use=${AGV_PROFILE_COUNTS} -fprofile-partial-training -fprofile-correction
      -Wno-missing-profile -Wno-coverage-mismatch
      "SHELL:--param max-inline-insns-auto=200" "SHELL:--param max-completely-peel-times=64"
      "SHELL:--param max-completely-peeled-insns=1000" "SHELL:--param max-peel-branches=256"
      "SHELL:--param tree-reassoc-width=4" -fno-tree-loop-im -fno-move-loop-invariants)
    target_compile_options(${target} PRIVATE ${options})
    target_link_options(${target} PRIVATE ${options})
    add_dependencies(${target} agv_profile)
  endforeach()
endfunction()
